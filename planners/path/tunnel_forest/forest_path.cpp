// From a tree that holds the start and a way out to a path that the checker
// accepts.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "dismantle/path/shortcuts.h"
#include "forest.h"

namespace dismantle::tunnel_forest {
namespace {

/// Paths are eased instant by instant, so many to a way of this length (assembly units).
constexpr double kEaseEvery = 0.1;
/// So often a path is eased again after the checker has named a place where it
/// cuts.
constexpr std::size_t kRepairs = 6;
/// What a straight motion may penetrate, as a share of the tolerance: easing takes it out again.
constexpr double kFreeShare = 0.2;
/// A straight motion is looked at in steps of this (assembly units), and is worth it if it saves this share.
constexpr double kLookEvery = 0.05, kWorthWhile = 0.9;
/// Turns between instants of a straight motion, rad.
constexpr double kTurn = 0.2;

}  // namespace

bool Forest::is_free(const std::vector<Pose>& poses) {
  State state = map_.node(0).state;
  for (std::size_t i = 0; i < poses.size(); ++i) state.bodies[i].pose = poses[i];
  ++looks_;
  return world_->penetration(state) <= kFreeShare * query_.tolerance;
}

/// Replaces what lies between two instants by the screw motion that joins them, again and again, where that is shorter
/// and free.
Path Forest::shortcut(const Path& path) {
  Path best = path;
  const auto direct = [&](std::size_t a, std::size_t b, Path& between) {
    double around = 0;
    for (std::size_t i = a; i < b; ++i) around += guide_.distance(best[i], best[i + 1]);
    const double straight = guide_.distance(best[a], best[b]);
    if (straight > kWorthWhile * around) return false;
    const auto at = [&](double u) {
      std::vector<Pose> poses;
      for (std::size_t i = 0; i < best[a].size(); ++i) poses.push_back(screw_interpolate(best[a][i], best[b][i], u));
      return poses;
    };
    const int looks = static_cast<int>(std::ceil(straight / kLookEvery));
    bool free = looks < 2 || is_free(at(0.5));
    for (int i = 1; i < looks && free; ++i) free = is_free(at(static_cast<double>(i) / looks));
    if (!free) return false;
    double turn = 0;
    for (std::size_t i = 0; i < best[a].size(); ++i) turn = std::max(turn, angle_between(best[a][i].q, best[b][i].q));
    const int pieces = std::max(1, static_cast<int>(std::ceil(turn / kTurn)));
    for (int i = 1; i < pieces; ++i) between.push_back(at(static_cast<double>(i) / pieces));
    return true;
  };
  path::shortcut_at_random(best, parameters_.shortcuts, rng_, direct, halted_);
  return path::thin(best, guide_.bodies(), parameters_.thinning);
}

/// The same path, off contact where there is room: a simulator samples contact, and what slides along something cuts it
/// a little between the samples.
Path Forest::eased(const Path& path) {
  Path dense{path.front()};
  State state = map_.node(0).state;
  for (std::size_t k = 1; k < path.size(); ++k) {
    if (halted_()) return path;
    const auto& before = path[k - 1];
    const int pieces = std::max(1, static_cast<int>(std::ceil(guide_.distance(before, path[k]) / kEaseEvery)));
    for (int i = 1; i <= pieces; ++i) {
      for (std::size_t b = 0; b < before.size(); ++b)
        state.bodies[b].pose = screw_interpolate(before[b], path[k][b], static_cast<double>(i) / pieces);
      ++looks_;
      // The end is out, and has to remain so.
      if (i < pieces || k + 1 < path.size()) world_->project_to_clearance(state, parameters_.clearance);
      dense.push_back(poses_of(state));
    }
  }
  return path::thin(dense, guide_.bodies(), parameters_.thinning);
}

/// Eased, and again where the checker has named a place where it cuts. What is
/// accepted goes to `result`.
path::Shown Forest::show(const Path& path, unsigned depth, PathResult& result) {
  Path form = path;
  return path::show_forms(
      query_.checker, refused_,
      [&](std::size_t round) -> std::optional<Path> {
        if (round > kRepairs) return std::nullopt;
        form = eased(form);
        return halted_() ? std::nullopt : std::optional(form);
      },
      [&](const PathCheck& check, const Path&) {
        result.message = check.reason;
        if (check.has_witness) world_->add_contact_sample(check.part, check.other, check.point);
        return check.has_witness;
      },
      [&](VerifiedPath verified) { result.solve(std::move(verified), depth); });
}

bool Forest::verified(PathResult& result) {
  while (map_.tree(map_.node(0).tree).out > 0 && refused_ < static_cast<std::uint64_t>(parameters_.max_refusals)) {
    const std::vector<Index> edges = map_.way_out(0);
    if (edges.empty()) return false;
    Path full{start_};
    std::vector<Index> ends;
    for (Index at = 0; const Index e : edges) {
      const Path way = map_.along(e, at);
      full.insert(full.end(), way.begin(), way.end());
      at = map_.other_end(e, at);
      ends.push_back(at);
    }
    const Path thinned = path::thin(full, guide_.bodies(), parameters_.thinning);
    const Path shorter = shortcut(thinned);
    const auto depth = static_cast<unsigned>(edges.size());
    path::Shown shown;
    if (shorter.size() < thinned.size()) shown = show(shorter, depth, result);
    if (!shown.accepted) shown = show(thinned, depth, result);
    if (shown.accepted) return true;
    if (halted_()) return false;
    // Easing moves instants by little: the edge at fault is the one that comes nearest to where it cuts.
    std::size_t guilty = edges.size() - 1;
    if (shown.last.has_witness) {
      const auto& place = shown.path[std::min(shown.last.instant, shown.path.size() - 1)];
      double least = std::numeric_limits<double>::infinity();
      Index at = 0;
      for (std::size_t e = 0; e < edges.size(); ++e) {
        for (const auto& instant : map_.along(edges[e], at))
          if (const double d = guide_.distance(place, instant); d < least) least = d, guilty = e;
        at = ends[e];
      }
    }
    map_.cut(edges[guilty]);
  }
  return false;
}

}  // namespace dismantle::tunnel_forest
