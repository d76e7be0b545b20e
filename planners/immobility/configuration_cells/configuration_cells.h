/// Two parts of any shape that hold each other: boxes of relative poses that no motion leaves.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct ConfigurationCellsParams {
  std::int64_t walk_checks = 6000;
  std::int64_t max_divisions = 100'000;
  static void describe(Schema<ConfigurationCellsParams>& s);
};

/// With the whole tolerance less is proved than with half of it. See pocket.h for the proof.
class ConfigurationCells final : public ImmobilityProver {
 public:
  explicit ConfigurationCells(const ConfigurationCellsParams& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override { return {ProofEffort::high, 2, 2, false}; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  ConfigurationCellsParams params_;
};

}  // namespace dismantle::immobility
