/// Proofs that pairs hold each other, some of them sought on idle threads before they are asked for.
#pragma once

#include <compare>
#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <span>

#include "dismantle/crew.h"
#include "dismantle/path_oracle.h"

namespace dismantle::blocking {

/// Do two parts hold each other?
struct HoldQuestion {
  enum class Kind : char {
    cage,               ///< ProofEffort::low
    flat,               ///< ProofEffort::medium; a is the smaller part
    confined_for_sure,  ///< ProofEffort::high
    confined_at_last,   ///< ProofEffort::high, for motions that cut in half as deep as paths may
  };
  Kind kind;
  PartId a, b;  ///< a < b, except for flat pieces
  auto operator<=>(const HoldQuestion&) const = default;

  static HoldQuestion of_pair(Kind kind, PartId a, PartId b) { return {kind, std::min(a, b), std::max(a, b)}; }
};

/// What is proved of a pair is a fact about the two, so it does not matter who finds it, and when. One caller.
class ProofsAhead {
 public:
  /// `oracle` must outlive this.
  explicit ProofsAhead(PathOracle& oracle) : oracle_(oracle) {}
  /// Tells what is still sought to stop, and waits for that.
  ~ProofsAhead();
  ProofsAhead(const ProofsAhead&) = delete;
  ProofsAhead& operator=(const ProofsAhead&) = delete;

  /// Offers the first of `wanted`, the likeliest to be asked first, to the context's crew. What is not among them any
  /// more is withdrawn, or told to stop.
  void begin(std::span<const HoldQuestion> wanted, const RunContext& context);
  /// The proof that they do, or null. Idle threads work on the first of `next` meanwhile.
  const Certificate* answer(const HoldQuestion& question, std::span<const HoldQuestion> next,
                            const RunContext& context);
  std::size_t open() const;  ///< offers that have not come to an end

 private:
  struct Job {
    CancelToken cancel;
    std::shared_ptr<const Certificate*> proof;
    Crew::Offer offer;
  };
  const Certificate* ask(const HoldQuestion& question, const RunContext& context) const;
  void drop_all_but(std::span<const HoldQuestion> wanted);

  PathOracle& oracle_;
  std::map<HoldQuestion, Job> jobs_;
  std::list<Job> dropped_;  // which come to an end
};

}  // namespace dismantle::blocking
