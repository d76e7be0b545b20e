/// Shows paths to the verifier, and lets the world learn from refusals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "dismantle/path/resume.h"
#include "dismantle/push_search/problem.h"
#include "dismantle/push_search/work.h"

namespace dismantle::push {

/// How the runs of one action, or of a whole expansion, ended.
enum class RunEnd {
  blocked,          ///< not separated
  solved,           ///< the path was accepted
  refused_learned,  ///< the path was refused, and the world has a new contact sample
  refused,          ///< the path was refused
  stop,             ///< the work or the time is used up
};

class Verification {
 public:
  /// `problem` outlives this.
  explicit Verification(Problem& problem) : problem_(problem) {}

  /// Checks a path at whose end the part is separated, after `depth` actions. `blocked`: the same path was refused
  /// before. Sets the result if the path is accepted, else its message.
  RunEnd show(const Path& path, unsigned depth, const Work& work, PathResult& result);
  /// Gives the world a contact sample of an earlier search.
  void learn(const path::ContactSample& sample);

  std::uint64_t refused() const { return refused_; }
  bool too_many() const { return refused_ > static_cast<std::uint64_t>(problem_.tactics.max_refusals); }
  const std::vector<path::ContactSample>& samples() const { return samples_; }

 private:
  /// A form of a path, and why the checker refused it.
  struct Refused {
    Path path{};
    PathCheck check{};
  };

  Path with_room(Path path, const Work& work) const;
  std::optional<Path> next_form(const Path& whole, std::size_t k, const Work& work, const Refused& last) const;

  Problem& problem_;
  std::vector<Path> refusals_;
  std::vector<path::ContactSample> samples_;
  std::uint64_t refused_ = 0;
};

}  // namespace dismantle::push
