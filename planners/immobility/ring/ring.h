/// A ring of one part in a chamber of another, all of whose openings are narrower.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct RingParameters {
  /// Circles that are tried within each solid, the largest first. Larger circles pass fewer openings.
  std::int64_t max_rings = 2;
  /// Positions along each axis of a part at which a circle is searched. Too few may miss thin rims.
  std::int64_t heights = 24;
  std::int64_t radii = 32;  ///< Radii that are tried at each position. More radii find a circle closer to the largest.
  /// Approximate number of planes across the axis in which the openings of a chamber are searched.
  std::int64_t max_sections = 150;
  static void describe(Schema<RingParameters>& s);
};

/// The proof is in ring_cage.h.
class Ring final : public ImmobilityProver {
 public:
  explicit Ring(const RingParameters& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override { return {ProofEffort::low, 2, 2, false}; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  RingParameters params_;
};

}  // namespace dismantle::immobility
