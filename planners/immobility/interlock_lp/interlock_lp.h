/// Several parts that hold each other in place: whichever of them move, none leaves a small region.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct InterlockLpParams {
  std::int64_t max_parts = 8;
  std::int64_t max_rounds = 60;
  double sample_spacing = 2;  ///< tolerances
  static void describe(Schema<InterlockLpParams>& s);
};

/// Proves immobility of all parts of the query, any of which may move. The proof is in interlock.h.
class InterlockLp final : public ImmobilityProver {
 public:
  explicit InterlockLp(const InterlockLpParams& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override {
    return {ProofEffort::high, 3, static_cast<std::size_t>(params_.max_parts), false};
  }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  InterlockLpParams params_;
};

}  // namespace dismantle::immobility
