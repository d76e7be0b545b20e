/// Parts on a common grid that no translations take apart.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct TranslationsParams {
  /// Largest number of arrangements of a proof. Its certificate lists them.
  std::int64_t arrangements = 20'000;
  /// Largest number of arrangements that are looked up.
  std::int64_t lookups = 5'000'000;
  static void describe(Schema<TranslationsParams>& s);
};

/// Proves that no translations separate the parts of the query, whichever of them move, also several at once. It does
/// not cover rotations, so it never answers for the full tolerance, which would mean that no valid motion exists.
class Translations final : public ImmobilityProver {
 public:
  explicit Translations(const TranslationsParams& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override;
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  TranslationsParams params_;
};

}  // namespace dismantle::immobility
