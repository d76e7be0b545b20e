/// A ring of one part in a chamber of another, all of whose openings are narrower.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct RingParams {
  std::int64_t max_rings = 2;
  static void describe(Schema<RingParams>& s);
};

/// See ring_cage.h for the proof.
class Ring final : public ImmobilityProver {
 public:
  explicit Ring(const RingParams& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override { return {ProofEffort::low, 2, 2, false}; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  RingParams params_;
};

}  // namespace dismantle::immobility
