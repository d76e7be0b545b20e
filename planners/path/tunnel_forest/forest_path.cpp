// Turns a tree that holds the start and a separated state into a path that the checker accepts.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "dismantle/search/placed_parts.h"
#include "dismantle/search/shortcuts.h"
#include "forest.h"

namespace dismantle::tunnel_forest {

bool Forest::is_free(const std::vector<Pose>& poses) {
  State state = map_.node(0).state;
  for (std::size_t i = 0; i < poses.size(); ++i) state.bodies[i].pose = poses[i];
  ++state_checks_;
  return world_->penetration(state) <= parameters_.free_penetration * query_.tolerance;
}

/// Replaces the path between two random instants with the screw motion between them if that is free and at least a
/// tenth shorter.
Path Forest::shortcut(const Path& path) {
  Path best = path;
  const auto direct = [&](std::size_t a, std::size_t b, Path& between) {
    double around = 0;
    for (std::size_t i = a; i < b; ++i) around += local_planner_.distance(best[i], best[i + 1]);
    const double straight = local_planner_.distance(best[a], best[b]);
    if (straight > 0.9 * around) return false;
    const auto at = [&](double u) {
      std::vector<Pose> poses;
      for (std::size_t i = 0; i < best[a].size(); ++i) poses.push_back(screw_interpolate(best[a][i], best[b][i], u));
      return poses;
    };
    const double spacing = parameters_.check_spacing * parameters_.node_spacing;
    const int checks = static_cast<int>(std::ceil(straight / spacing));
    bool free = checks < 2 || is_free(at(0.5));
    for (int i = 1; i < checks && free; ++i) free = is_free(at(static_cast<double>(i) / checks));
    if (!free) return false;
    double turn = 0;
    for (std::size_t i = 0; i < best[a].size(); ++i) turn = std::max(turn, angle_between(best[a][i].q, best[b][i].q));
    const int pieces = std::max(1, static_cast<int>(std::ceil(turn / path::kMostTurn)));
    for (int i = 1; i < pieces; ++i) between.push_back(at(static_cast<double>(i) / pieces));
    return true;
  };
  path::shortcut_at_random(best, parameters_.shortcuts, rng_, direct, halted_);
  return path::thin(best, local_planner_.bodies(), parameters_.thinning);
}

/// Moves each pose of a path away from contact where there is room. Simulators sample contact, so a part that slides
/// along an obstacle penetrates slightly between the samples.
Path Forest::retracted(const Path& path) {
  const double spacing = 2 * parameters_.check_spacing * parameters_.node_spacing;
  Path dense{path.front()};
  State state = map_.node(0).state;
  for (std::size_t k = 1; k < path.size(); ++k) {
    if (halted_()) return path;
    const auto& before = path[k - 1];
    const int pieces = std::max(1, static_cast<int>(std::ceil(local_planner_.distance(before, path[k]) / spacing)));
    for (int i = 1; i <= pieces; ++i) {
      for (std::size_t b = 0; b < before.size(); ++b)
        state.bodies[b].pose = screw_interpolate(before[b], path[k][b], static_cast<double>(i) / pieces);
      ++state_checks_;
      // The last pose is separated and must remain so.
      if (i < pieces || k + 1 < path.size()) world_->project_to_clearance(state, parameters_.clearance);
      dense.push_back(path::poses_of(state));
    }
  }
  return path::thin(dense, local_planner_.bodies(), parameters_.thinning);
}

/// Shows the retracted path to the checker. Retracts and shows it again after the checker has reported where it
/// penetrates. The accepted path goes to `result`.
path::Shown Forest::check_forms(const Path& path, unsigned depth, PathResult& result) {
  Path form = path;
  return path::show_forms(
      query_.checker, refused_,
      [&](std::size_t round) -> std::optional<Path> {
        if (round > static_cast<std::size_t>(parameters_.repairs)) return std::nullopt;
        form = retracted(form);
        return halted_() ? std::nullopt : std::optional(form);
      },
      [&](const PathCheck& check, const Path&) {
        result.message = check.reason;
        if (check.has_witness) world_->add_contact_sample(check.part, check.other, check.point);
        return check.has_witness;
      },
      [&](VerifiedPath verified) { result.solve(std::move(verified), depth); });
}

bool Forest::find_verified_path(PathResult& result) {
  while (map_.tree(map_.node(0).tree).separated > 0 &&
         refused_ < static_cast<std::uint64_t>(parameters_.max_refusals)) {
    const std::vector<Index> edges = map_.edges_to_separated(0);
    if (edges.empty()) return false;
    Path full{start_};
    std::vector<Index> ends;
    for (Index at = 0; const Index e : edges) {
      const Path piece = map_.along(e, at);
      full.insert(full.end(), piece.begin(), piece.end());
      at = map_.other_end(e, at);
      ends.push_back(at);
    }
    const Path thinned = path::thin(full, local_planner_.bodies(), parameters_.thinning);
    const Path shorter = shortcut(thinned);
    const auto depth = static_cast<unsigned>(edges.size());
    path::Shown shown;
    if (shorter.size() < thinned.size()) shown = check_forms(shorter, depth, result);
    if (!shown.accepted) shown = check_forms(thinned, depth, result);
    if (shown.accepted) return true;
    if (halted_()) return false;
    // Retraction moves poses only slightly, so the edge nearest to the reported place is at fault.
    std::size_t at_fault = edges.size() - 1;
    if (shown.last.has_witness) {
      const auto& place = shown.path[std::min(shown.last.instant, shown.path.size() - 1)];
      double least = std::numeric_limits<double>::infinity();
      Index at = 0;
      for (std::size_t e = 0; e < edges.size(); ++e) {
        for (const auto& instant : map_.along(edges[e], at))
          if (const double d = local_planner_.distance(place, instant); d < least) least = d, at_fault = e;
        at = ends[e];
      }
    }
    map_.cut(edges[at_fault]);
  }
  return false;
}

}  // namespace dismantle::tunnel_forest
