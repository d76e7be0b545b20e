#include "blocking/lattice_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;
using lattice::Cell;

// Material that reaches into a cell by less than this share of its edge does not fill it: the curved outside of a
// piece may bulge a little over its cells.
constexpr double kInset = 0.1;
// Parts with more triangles are hardly pieces on a grid.
constexpr std::size_t kMostTriangles = 20'000;

TranslationSearch::End end_of(lattice::SearchResult::End end) {
  using From = lattice::SearchResult::End;
  using To = TranslationSearch::End;
  switch (end) {
    case From::found:
      return To::found;
    case From::exhausted:
      return To::exhausted;
    case From::limit:
      return To::too_long;
    case From::stopped:
      return To::stopped;
    case From::unsuited:
      break;
  }
  return To::unsuited;
}

}  // namespace

const std::vector<Cell>& LatticeSearch::cells(PartId part) {
  const auto [entry, is_new] = cells_.try_emplace(part);
  if (is_new)
    entry->second = lattice::cells_of(*assembly_.parts[part].mesh, *lattice_, Vec3::Constant(kInset), true);
  return entry->second;
}

TranslationSearch::Answer LatticeSearch::search(const Places& places, std::size_t most_states, double most_work,
                                                const RunContext& context) {
  TranslationSearch::Answer answer;
  if (places.size() > lattice::kMostParts) return answer;
  if (!lattice_) {
    std::vector<const Mesh*> meshes;
    for (const auto& [part, at] : places) {
      meshes.push_back(assembly_.parts[part].mesh.get());
      if (meshes.back()->triangles.size() > kMostTriangles || assembly_.parts[part].open) return answer;
    }
    lattice_ = lattice::lattice_of(meshes, tolerance_);
    if (!lattice_) return answer;
  }
  std::vector<std::vector<Cell>> parts;
  std::vector<PartId> ids;
  const Vec3 first = places.begin()->second;
  for (const auto& [part, at] : places) {
    const Vec3 steps = (lattice_->axes * (at - first)).cwiseQuotient(lattice_->pitch);
    const Vec3 whole = steps.array().round();
    if (((steps - whole).cwiseProduct(lattice_->pitch)).cwiseAbs().maxCoeff() > tolerance_) return answer;
    parts.push_back(cells(part));
    ids.push_back(part);
    for (Cell& c : parts.back())
      for (std::size_t k = 0; k < 3; ++k) c[k] += static_cast<int>(whole[static_cast<Eigen::Index>(k)]);
  }
  const lattice::SearchResult found =
      lattice::search_arrangements(parts, {most_states, most_work, [&] { return context.should_stop(); }});
  answer.end = end_of(found.end);
  answer.states = found.visited;
  answer.waiting = found.waiting;
  for (const lattice::Slide& slide : found.slides) {
    Translation translation;
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (slide.parts >> i & 1) translation.parts.push_back(ids[i]);
    const double sign = slide.leaves != 0 ? slide.leaves : slide.steps < 0 ? -1 : 1;
    translation.direction = sign * lattice_->axes.row(slide.axis).transpose();
    translation.length = slide.leaves != 0 ? std::numeric_limits<double>::infinity()
                                           : std::abs(slide.steps) * lattice_->pitch[slide.axis];
    answer.translations.push_back(std::move(translation));
  }
  return answer;
}

std::string LatticeSearch::summary(const TranslationSearch::Answer& answer) const {
  if (!lattice_) return "arrangements on a grid: the parts do not lie on one";
  std::string cells;
  for (const auto& [part, own] : cells_) cells += " " + std::to_string(own.size());
  return "arrangements on a grid: pitch " + std::to_string(lattice_->pitch.x()) + " " +
         std::to_string(lattice_->pitch.y()) + " " + std::to_string(lattice_->pitch.z()) + ", cells" + cells + "; " +
         (answer.end == TranslationSearch::End::unsuited ? "two parts share a cell, or one is off the grid" : "") +
         std::to_string(answer.states) + " visited, " + std::to_string(answer.waiting) + " waiting, " +
         std::to_string(answer.translations.size()) + " translations";
}

}  // namespace dismantle::blocking
