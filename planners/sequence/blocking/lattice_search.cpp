#include "blocking/lattice_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;
using lattice::Cell;

// A cell is full if this share of its edge on each side of its middle is material: two such parts overlap deeply.
constexpr double kCore = 0.1;
// A part reaches into a cell if it does so by more than this multiple of the tolerance.
constexpr double kReach = 2;
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

const lattice::PieceCells& LatticeSearch::cells(PartId part) {
  const auto [entry, is_new] = cells_.try_emplace(part);
  if (is_new) {
    const Mesh& mesh = *assembly_.parts[part].mesh;
    const Vec3 reach = (kReach * tolerance_ * lattice_->pitch.cwiseInverse()).cwiseMin(kCore);
    entry->second = {lattice::full_cells_of(mesh, *lattice_, Vec3::Constant(0.5 - kCore)),
                     lattice::cells_of(mesh, *lattice_, reach, true)};
  }
  return entry->second;
}

/// Does a part, translated by `at` relative to another, move on by `by` without running into it?
bool LatticeSearch::passes(PartId moving, PartId fixed, const Vec3& at, const Vec3& by) const {
  const auto pose = [](const Vec3& t) { return Pose{t, Eigen::Quaterniond::Identity()}; };
  return sweep_.passes(moving, fixed, Pose{}, {pose(at), pose(at + by)});
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
  std::vector<lattice::PieceCells> parts;
  std::vector<PartId> ids;
  std::vector<Cell> placed;
  const Vec3 first = places.begin()->second;
  for (const auto& [part, at] : places) {
    const Vec3 steps = (lattice_->axes * (at - first)).cwiseQuotient(lattice_->pitch);
    const Vec3 whole = steps.array().round();
    if (((steps - whole).cwiseProduct(lattice_->pitch)).cwiseAbs().maxCoeff() > tolerance_) return answer;
    parts.push_back(cells(part));
    ids.push_back(part);
    placed.push_back({});
    for (std::size_t k = 0; k < 3; ++k) placed.back()[k] = static_cast<int>(whole[static_cast<Eigen::Index>(k)]);
    for (auto* list : {&parts.back().full, &parts.back().touched})
      for (Cell& c : *list)
        for (std::size_t k = 0; k < 3; ++k) c[k] += placed.back()[k];
  }
  asked_ = 0;
  const auto passes_step = [&](std::size_t i, std::size_t j, const Cell& shift, int axis) {
    ++asked_;
    Vec3 steps;
    for (std::size_t k = 0; k < 3; ++k) steps[static_cast<Eigen::Index>(k)] = shift[k] + placed[i][k] - placed[j][k];
    return passes(ids[i], ids[j], lattice_->translation(steps), lattice_->translation(Vec3::Unit(axis)));
  };
  const lattice::SearchResult found =
      lattice::search_arrangements(parts, passes_step, {most_states, most_work, [&] { return context.should_stop(); }});
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
  for (const auto& [part, own] : cells_)
    cells += " " + std::to_string(own.full.size()) + "/" + std::to_string(own.touched.size());
  return "arrangements on a grid: pitch " + std::to_string(lattice_->pitch.x()) + " " +
         std::to_string(lattice_->pitch.y()) + " " + std::to_string(lattice_->pitch.z()) + ", cells" + cells + "; " +
         (answer.end == TranslationSearch::End::unsuited ? "two parts share a cell, or one is off the grid" : "") +
         std::to_string(answer.states) + " visited, " + std::to_string(asked_) + " steps of pairs examined, " +
         std::to_string(answer.waiting) + " waiting, " + std::to_string(answer.translations.size()) + " translations";
}

}  // namespace dismantle::blocking
