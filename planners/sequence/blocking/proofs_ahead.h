/// Proofs that pairs hold each other, some of them sought on idle threads before they are asked for.
#pragma once

#include <compare>
#include <cstddef>
#include <memory>
#include <span>

#include "dismantle/path_oracle.h"
#include "dismantle/speculative_cache.h"

namespace dismantle::blocking {

/// Do two parts hold each other?
struct ImmobilityQuestion {
  enum class Kind : char {
    cage,           ///< ProofEffort::low
    flat,           ///< up to ProofEffort::medium; a is the smaller part
    confined_full,  ///< up to ProofEffort::high, for motions that cut in as deep as paths may
    confined_half,  ///< the same, where ProofEffort::high is for motions that cut in half as deep
  };
  Kind kind;
  PartId a, b;  ///< a < b, except for flat pieces
  auto operator<=>(const ImmobilityQuestion&) const = default;

  static ImmobilityQuestion of_pair(Kind kind, PartId a, PartId b) { return {kind, std::min(a, b), std::max(a, b)}; }
};

/// What is proved of a pair is a fact about the two, so it does not matter which thread finds it and when. One
/// caller.
class ProofsAhead {
 public:
  /// `late_share`: share of the tolerance for Kind::confined_half. All must outlive this; `executor` may be null.
  ProofsAhead(PathOracle& oracle, double late_share, std::shared_ptr<Executor> executor)
      : oracle_(oracle), late_share_(late_share), known_(std::move(executor), Executor::Priority::speculative) {}

  /// Idle threads work on the first few of `wanted`, the likeliest to be asked first, that are not known. What is not
  /// among them any more is cancelled.
  void begin(std::span<const ImmobilityQuestion> wanted, const RunContext& context);
  /// The proof that they do, or null. Idle threads work on the first of `next` meanwhile.
  const Certificate* answer(const ImmobilityQuestion& question, std::span<const ImmobilityQuestion> next,
                            const RunContext& context);

 private:
  using Known = SpeculativeCache<ImmobilityQuestion, const Certificate*>;
  const Certificate* ask(const ImmobilityQuestion& question, const RunContext& context) const;

  PathOracle& oracle_;
  double late_share_;
  Known known_;
};

}  // namespace dismantle::blocking
