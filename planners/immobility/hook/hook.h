/// A part through a hole of another, between two bends that cannot follow.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct HookParams {
  std::int64_t max_holes = 4;
  std::int64_t max_bends = 3;
  static void describe(Schema<HookParams>& s);
};

/// See hook_cage.h for the proof.
class Hook final : public ImmobilityProver {
 public:
  explicit Hook(const HookParams& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override { return {ProofEffort::medium, 2, 2, false}; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  HookParams params_;
};

}  // namespace dismantle::immobility
