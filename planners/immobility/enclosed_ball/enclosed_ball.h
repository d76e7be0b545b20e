/// A part that contains a ball too large for every gap between the surrounding parts.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct EnclosedBallParameters {
  /// Limit of divided cubes in the search for the largest ball within a part. With fewer, the ball may be smaller than
  /// 0.95 times the largest.
  std::int64_t max_cubes = 2000;
  /// Limit of cubic cells that the ball's centre reaches, after which the proof is given up. A million take about two
  /// seconds.
  std::int64_t max_cells = 1'000'000;
  static void describe(Schema<EnclosedBallParameters>& s);
};

/// The largest ball within a moving part, reduced by the allowed penetration, against the surfaces of the fixed parts
/// at their poses. A surface point inside the ball is at least as deep in the moving part as it is in the ball.
class EnclosedBall final : public ImmobilityProver {
 public:
  explicit EnclosedBall(const EnclosedBallParameters& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override;
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  std::optional<Certificate> prove(const SeparationQuery& query, const std::vector<PlacedPart>& inner,
                                   const std::vector<PlacedPart>& outer, const RunContext& context) const;
  EnclosedBallParameters params_;
};

}  // namespace dismantle::immobility
