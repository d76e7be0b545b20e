/// Parts with so deep an initial overlap that no valid motion separates them.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct OverlapLockParameters {
  /// Limit of divided cubes of the common box of two solids, in the search for a point that locks them. Fewer may miss
  /// small overlaps of large parts.
  std::int64_t max_cubes = 1000;
  static void describe(Schema<OverlapLockParameters>& s);
};

/// A point lies in both parts, deeper below the surface of the first than the pair may penetrate. The argument is in
/// deep_common_point.h.
class OverlapLock final : public ImmobilityProver {
 public:
  explicit OverlapLock(const OverlapLockParameters& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override { return {ProofEffort::trivial, 2, 2, false}; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  OverlapLockParameters params_;
};

}  // namespace dismantle::immobility
