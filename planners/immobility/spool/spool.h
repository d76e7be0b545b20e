/// A part through a hole of another, between two rims that are wider than a circle about the hole.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct SpoolParameters {
  std::int64_t max_rings = 4;  ///< Circles that are tried about each axis of the spool, the narrowest first.
  /// Positions along each axis of the spool at which a circle is searched. Too few may miss thin plates.
  std::int64_t heights = 24;
  /// Radii that are tried at each position. More radii find a circle closer to the narrowest.
  std::int64_t radii = 128;
  std::int64_t max_sections = 150;  ///< Approximate number of planes across the axis in which rims are searched.
  /// Distance by which a rim may differ from a convex curve, in multiples of verify.max_penetration. The circle must be
  /// deeper by the same amount.
  double max_dent = 0.01;
  static void describe(Schema<SpoolParameters>& s);
};

/// The proof is in spool_cage.h.
class Spool final : public ImmobilityProver {
 public:
  explicit Spool(const SpoolParameters& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override { return {ProofEffort::low, 2, 2, false}; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  SpoolParameters params_;
};

}  // namespace dismantle::immobility
