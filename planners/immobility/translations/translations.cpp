#include "translations/translations.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "dismantle/geometry/numerics.h"
#include "dismantle/immobility/query.h"
#include "dismantle/lattice/arrangements.h"

namespace dismantle::immobility {
namespace {

using Eigen::Vector3d;
using lattice::Cell;
using lattice::SearchResult;

// Parts with more triangles are hardly pieces on a grid.
constexpr std::size_t kMostTriangles = 20'000;
// Where a curved outside cuts cells, parts of them may be whole: cells are divided into up to this number along each
// axis.
constexpr int kFinest = 3;

std::vector<PartId> parts_of(const SeparationQuery& query) {
  std::vector<PartId> parts;
  for (const auto* list : {&query.moving, &query.fixed})
    for (const PlacedPart& p : *list) parts.push_back(p.part);
  std::sort(parts.begin(), parts.end());
  return parts;
}

}  // namespace

void TranslationsParameters::describe(Schema<TranslationsParameters>& s) {
  s.advanced("arrangements", &TranslationsParameters::arrangements, {1, 1e7});
  s.advanced("lookups", &TranslationsParameters::lookups, {1, 1e12});
}

ProverTraits Translations::traits() const noexcept { return {ProofEffort::low, 2, lattice::kMostParts, false}; }

/// All arrangements of the cores of cells on a grid. `deep`: how much deeper than the core the material has to reach.
Translations::Proof Translations::search(const std::vector<const Mesh*>& meshes, const lattice::Lattice& grid,
                                         double deep, const RunContext& context) const {
  Proof proof;
  // How much of a cell the core leaves on each side: nearly the most that the proof allows, since then most cells have
  // a core, and those cores are deepest in their parts.
  proof.inset = 0.49 / static_cast<double>(meshes.size()) * grid.pitch;
  const Vector3d kept = (proof.inset - Vector3d::Constant(deep)).cwiseQuotient(grid.pitch);
  if (kept.minCoeff() <= 0) return proof;
  proof.whole = true;
  for (const Mesh* mesh : meshes) {
    proof.cells.push_back(lattice::full_cells_of(*mesh, grid, kept));
    proof.whole = proof.whole && proof.cells.back() == lattice::cells_of(*mesh, grid, kept, true);
  }
  proof.all =
      lattice::search_arrangements(proof.cells,
                                   {static_cast<std::size_t>(params_.arrangements),
                                    static_cast<double>(params_.lookups), [&] { return context.should_stop(); }},
                                   true);
  return proof;
}

std::optional<Certificate> Translations::prove(const SeparationQuery& query, const RunContext& context) const {
  if (query.share >= 1 - geometry::kRounding) return std::nullopt;
  Certificate found;
  found.parts = parts_of(query);
  std::vector<const Mesh*> meshes;
  for (const PartId id : found.parts) {
    const Part& part = query.assembly.parts.at(id);
    if (part.open || part.mesh->triangles.size() > kMostTriangles) return std::nullopt;
    meshes.push_back(part.mesh.get());
  }
  auto grid = lattice::lattice_of(meshes, query.tolerance);
  if (!grid) return std::nullopt;
  double allowed = 0;
  for (const PartId part : found.parts)
    for (const PartId other : found.parts)
      if (other != part) allowed = std::max(allowed, depth_allowed(query, part, other));
  const Vector3d pitch = grid->pitch;
  Proof proof;
  for (int parts_of_cell = 1; parts_of_cell <= kFinest; ++parts_of_cell) {
    grid->pitch = pitch / parts_of_cell;
    proof = search(meshes, *grid, allowed + slack_of(query), context);
    if (proof.all.end == SearchResult::End::exhausted) break;
    if (proof.whole || proof.all.end == SearchResult::End::stopped) return std::nullopt;
  }
  if (proof.all.end != SearchResult::End::exhausted) return std::nullopt;
  const Eigen::Quaterniond q(Eigen::Matrix3d(grid->axes.transpose()));
  auto& n = found.numbers;
  n["axes"] = {q.w(), q.x(), q.y(), q.z()};
  n["pitch"] = numbers_of(grid->pitch);
  n["origin"] = numbers_of(grid->origin);
  n["inset"] = numbers_of(proof.inset);
  const auto append = [](std::vector<double>& to, const std::vector<Cell>& from) {
    for (const Cell& c : from) to.insert(to.end(), c.begin(), c.end());
  };
  for (const auto& own : proof.cells) {
    n["counts"].push_back(static_cast<double>(own.size()));
    append(n["cells"], own);
  }
  for (const auto& shifts : proof.all.arrangements) append(n["arrangements"], shifts);
  found.text = fmt::format(
      "no translations take {} apart, whichever of them move, also several at once: they can reach {} on "
      "their grid of {:.4g} x {:.4g} x {:.4g}, all were visited, and from none a part or group leaves (while they "
      "penetrate less than {:.4g} deeper than when assembled; rotations are not covered)",
      names_of(query, found.parts),
      proof.all.visited == 1 ? std::string("1 arrangement") : fmt::format("{} arrangements", proof.all.visited),
      input_length(query, grid->pitch.x()), input_length(query, grid->pitch.y()), input_length(query, grid->pitch.z()),
      input_length(query, query.margin()));
  return found;
}

}  // namespace dismantle::immobility
