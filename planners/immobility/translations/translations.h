/// Parts on a common grid that no translations take apart.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "dismantle/immobility_prover.h"
#include "dismantle/lattice/arrangements.h"
#include "dismantle/parameters.h"

namespace dismantle::immobility {

struct TranslationsParameters {
  /// Largest number of arrangements of a proof. Its certificate lists them.
  std::int64_t arrangements = 20'000;
  /// Largest number of arrangements that are looked up.
  std::int64_t lookups = 5'000'000;
  static void describe(Schema<TranslationsParameters>& s);
};

/// Proves that no translations separate the parts of the query, whichever of them move, also several at once. It does
/// not cover rotations, so it never answers for the full tolerance, which would mean that no valid motion exists.
class Translations final : public ImmobilityProver {
 public:
  explicit Translations(const TranslationsParameters& params = {}) : params_(params) {}
  ProverTraits traits() const noexcept override;
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override;

 private:
  struct Proof {
    Eigen::Vector3d inset = Eigen::Vector3d::Zero();
    std::vector<std::vector<lattice::Cell>> cells;
    bool whole = false;  ///< no cell is cut: a finer grid has no more material
    lattice::SearchResult all;
  };
  Proof search(const std::vector<const Mesh*>& meshes, const lattice::Lattice& grid, double deep,
               const RunContext& context) const;

  TranslationsParameters params_;
};

}  // namespace dismantle::immobility
