/// A bar through a hole of another part, between two bends that cannot pass the hole.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct HookParams {
  std::int64_t max_holes = 4;
  std::int64_t max_bends = 3;
  std::int64_t max_nodes = 1200;
  std::int64_t max_distances = 6'000'000;
  double min_bend = 0.87;  ///< rad
  static void describe(Schema<HookParams>& s);
};

/// The proof is in hook_cage.h.
class Hook final : public ImmobilityProver {
 public:
  explicit Hook(const HookParams& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override { return {ProofEffort::medium, 2, 2, false}; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  HookParams params_;
};

}  // namespace dismantle::immobility
