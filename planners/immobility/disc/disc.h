/// A flat piece of one part in a chamber of another, whose openings it cannot pass.
#pragma once

#include <cstdint>

#include "dismantle/immobility_prover.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct DiscParameters {
  /// Discs that are tried in each solid, the largest first. A larger disc passes fewer openings, so more than one disc
  /// helps only for parts with several flat pieces.
  std::int64_t max_discs = 1;
  std::int64_t max_divisions = 60'000;
  /// Limit of facet tests, after which the proof is given up; the search for an exit of the cells counts, too. 6e7 take
  /// about two seconds. Most proofs need a third.
  std::int64_t max_facets = 60'000'000;
  static void describe(Schema<DiscParameters>& s);
};

/// The smaller part of a pair has the disc, the larger part the chamber. The proof is in disc_cage.h.
class Disc final : public ImmobilityProver {
 public:
  explicit Disc(const DiscParameters& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override { return {ProofEffort::medium, 2, 2, false}; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  DiscParameters params_;
};

}  // namespace dismantle::immobility
