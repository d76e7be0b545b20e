/// Several parts that hold each other in place: whichever of them move, none leaves a small region.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct InterlockLpParameters {
  std::int64_t max_parts = 8;
  /// How often the assumed bounds of the motions are widened before the proof is given up. Most proofs need less than
  /// ten rounds.
  std::int64_t max_rounds = 60;
  /// Distance between the interior points that the proof uses, in multiples of verify.max_penetration. Fewer points are
  /// faster, but miss contacts of small features.
  double sample_spacing = 2;
  static void describe(Schema<InterlockLpParameters>& s);
};

/// Proves immobility of all parts of the query, any of which may move. The proof is in interlock.h.
class InterlockLp final : public ImmobilityProver {
 public:
  explicit InterlockLp(const InterlockLpParameters& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override {
    return {ProofEffort::high, 3, static_cast<std::size_t>(params_.max_parts), false};
  }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  InterlockLpParameters params_;
};

}  // namespace dismantle::immobility
