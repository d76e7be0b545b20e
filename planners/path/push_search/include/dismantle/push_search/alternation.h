/// Searches by translation and by rotation in alternation.
#pragma once

#include <memory>
#include <optional>

#include "dismantle/push_search/reached.h"
#include "dismantle/push_search/search.h"

namespace dismantle::push {

/// The rank up to which states are expanded grows, in translation and in rotation by turns, until both are exhausted.
/// So states of low rank in one motion space come before states of high rank in the other.
class Alternation {
 public:
  /// All arguments outlive this.
  Alternation(const PathQuery& query, const Tactics& tactics, RunContext& context);

  /// Continues where the last call stopped. Ignores Limits::rank. Outcome `depth_limit`: paused.
  PathResult run(const Limits& limits);
  bool paused() const { return paused_; }
  /// The search trees of both.
  std::shared_ptr<const Reached> reached() const;

 private:
  Search& rotation();
  std::uint64_t cost() const;
  bool try_screws(const Limits& limits);
  bool run_next(Limits limits);

  const PathQuery& query_;
  const Tactics& tactics_;
  RunContext& context_;
  Search translation_;
  std::optional<Search> rotation_;
  PathResult translated_, rotated_;  ///< last results
  unsigned rank_;
  bool rotates_ = false;             ///< rotation comes next
  std::optional<bool> screw_first_;  ///< screws come before all others; set by the first run(), false once they have
  bool paused_ = false;
};

}  // namespace dismantle::push
