/// Merges parts that are proved inseparable: a ring in a groove, a bent bar in a hole. They are moved as one from then
/// on, and reported with the proof.
#pragma once

#include "blocking/immobility.h"
#include "blocking_graph/strategy.h"

namespace dismantle::blocking {

/// Quick proofs about all pairs, and those about parts that were searched to some depth.
class MergeImmobile final : public Strategy {
 public:
  explicit MergeImmobile(Immobility& immobility) : immobility_(immobility) {}
  std::string_view name() const noexcept override { return "merge_immobile"; }
  Cost cost() const noexcept override { return Cost::quick_proofs; }
  Result apply(GroupState& group) override {
    return immobility_.merge_caged(group) || immobility_.merge_confined_early(group) ? Result::restart
                                                                                     : Result::unchanged;
  }

 private:
  Immobility& immobility_;
};

/// Expensive proofs, after all searches.
class MergeImmobileLate final : public Strategy {
 public:
  explicit MergeImmobileLate(Immobility& immobility) : immobility_(immobility) {}
  std::string_view name() const noexcept override { return "merge_immobile_late"; }
  Cost cost() const noexcept override { return Cost::long_proofs; }
  Result apply(GroupState& group) override {
    return immobility_.merge_flat(group) || immobility_.merge_interlocked(group) ||
                   immobility_.merge_confined_late(group)
               ? Result::restart
               : Result::unchanged;
  }

 private:
  Immobility& immobility_;
};

}  // namespace dismantle::blocking
