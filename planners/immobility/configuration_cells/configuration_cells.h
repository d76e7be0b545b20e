/// Two parts of any shape that cannot be separated: a region of relative poses that no motion leaves.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

/// Lengths are multiples of the tolerance. The parameters affect only the effort, not the soundness of a proof.
struct ConfigurationCellsParams {
  std::int64_t walk_checks = 6000;
  std::int64_t max_divisions = 100'000;
  std::int64_t patience = 500;
  double sample_spacing = 2;
  double smallest_cell = 0.05;
  double separation = 300;
  static void describe(Schema<ConfigurationCellsParams>& s);
};

/// The proof is in cage.h. For the whole tolerance it succeeds less often than for half of it.
class ConfigurationCells final : public ImmobilityProver {
 public:
  explicit ConfigurationCells(const ConfigurationCellsParams& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override { return {ProofEffort::high, 2, 2, false}; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  ConfigurationCellsParams params_;
};

}  // namespace dismantle::immobility
