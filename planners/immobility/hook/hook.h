/// A bar through a hole of another part, between two bends that cannot pass the hole.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct HookParameters {
  /// Holes around a bar that are tried, those around the thickest pieces of the bar first.
  std::int64_t max_holes = 4;
  std::int64_t max_bends = 3;  ///< Bends that are tried on each side of a hole, the sharpest first.
  /// Points on the middle line of a bar, the deepest first. Time grows with the square of their number. Too few leave
  /// gaps in long wires.
  std::int64_t max_nodes = 1200;
  /// Distance queries for the proof that one bend cannot pass one hole: 6e6 take a few seconds.
  std::int64_t max_distances = 6'000'000;
  /// Bends with a smaller angle are not tried, since they pass almost any hole that the bar passes (rad).
  double min_bend = 0.87;
  static void describe(Schema<HookParameters>& s);
};

/// The proof is in hook_cage.h.
class Hook final : public ImmobilityProver {
 public:
  explicit Hook(const HookParameters& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override { return {ProofEffort::medium, 2, 2, false}; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  HookParameters params_;
};

}  // namespace dismantle::immobility
