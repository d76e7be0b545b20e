/// Two parts of any shape that cannot be separated: a region of relative poses that no motion leaves.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

/// Lengths are multiples of the tolerance. The parameters affect only the effort, not the soundness of a proof.
struct ConfigurationCellsParameters {
  /// State checks of the random search that precedes the proof. If it separates the parts, no proof is tried. Too few
  /// checks waste time on proofs that must fail.
  std::int64_t walk_checks = 6000;
  std::int64_t max_divisions = 100'000;
  /// Divisions without progress after which the random search extends to where cells lead, and the decomposed box grows
  /// on a side to which all of them lead. Lower values react sooner to long free motions, higher values spend fewer
  /// state checks.
  std::int64_t patience = 500;
  /// Distance between the interior points that the proof uses. Fewer points are faster, but miss contacts of small
  /// features. It is larger in large parts, so that each part has at most a few thousand points
  ///, in multiples of verify.max_penetration.
  double sample_spacing = 2;
  /// Cells with a smaller displacement between their poses are not divided. If a way out leads through one, the proof
  /// is given up, in multiples of verify.max_penetration.
  double smallest_cell = 0.05;
  /// Displacement at which the random search counts the parts as separated, or the radius of the smaller part, if that
  /// is more. It must exceed the distance that parts can slide without being separated, in multiples of
  /// verify.max_penetration.
  double separation = 300;
  static void describe(Schema<ConfigurationCellsParameters>& s);
};

/// The proof is in cage.h. For the whole tolerance it succeeds less often than for half of it.
class ConfigurationCells final : public ImmobilityProver {
 public:
  explicit ConfigurationCells(const ConfigurationCellsParameters& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override { return {ProofEffort::high, 2, 2, false}; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  ConfigurationCellsParameters params_;
};

}  // namespace dismantle::immobility
