/// Proofs that pairs hold each other, some of them sought on other threads before they are asked for.
#pragma once

#include <future>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "dismantle/verify/verifier.h"

namespace dismantle::blocking {

/// What the judge says of a pair is a fact about the two, so it does not matter who finds it, and when. One caller.
class ConfinementsAhead {
 public:
  using Pair = std::pair<PartId, PartId>;

  /// `judge` must outlive this.
  explicit ConfinementsAhead(const Verifier& judge) : judge_(judge) {}
  /// Tells what is still sought to stop, and waits for that.
  ~ConfinementsAhead();
  ConfinementsAhead(const ConfinementsAhead&) = delete;
  ConfinementsAhead& operator=(const ConfinementsAhead&) = delete;

  /// Begins with the first of `pairs`, as long as so many threads or fewer are at work here.
  void begin(std::span<const Pair> pairs, std::size_t threads, const RunContext& context);
  /// Verifier::confined; with more than one thread, the others work on the first of `next` meanwhile.
  std::optional<Confinement> answer(const Pair& pair, std::span<const Pair> next, const RunContext& context);

 private:
  struct Job {
    CancelToken cancel;
    std::future<std::optional<Confinement>> found;
  };
  std::size_t working() const;

  const Verifier& judge_;
  std::map<Pair, Job> jobs_;
};

}  // namespace dismantle::blocking
