#include "assembly_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dismantle/geometry/disjoint_sets.h"
#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/mesh_measure.h"
#include "parallel_phase.h"

namespace dismantle {
namespace {

/// All vertices of `a` lie within `tolerance` of the surface of `b`.
bool lies_on(const Mesh& a, const TriangleBvh& b, double tolerance) {
  return std::all_of(a.vertices.begin(), a.vertices.end(),
                     [&](const auto& p) { return b.closest(p, tolerance).distance <= tolerance; });
}

bool same_place(const Candidate& a, const Candidate& b) {
  const double tolerance = 1e-6 * std::max(a.box.size().norm(), b.box.size().norm());
  if ((a.box.lo - b.box.lo).norm() > tolerance || (a.box.hi - b.box.hi).norm() > tolerance) return false;
  if (std::abs(a.volume - b.volume) > 1e-4 * std::max(a.volume, b.volume)) return false;
  return lies_on(a.mesh, TriangleBvh(b.mesh), tolerance) && lies_on(b.mesh, TriangleBvh(a.mesh), tolerance);
}

/// Points inside one part, and for each other part which of them it covers.
struct Coverage {
  std::size_t points = 0;
  std::vector<std::pair<std::size_t, std::vector<char>>> by;

  double share(const std::vector<char>& gone) const {
    std::size_t covered = 0;
    for (std::size_t k = 0; k < points; ++k)
      covered += std::any_of(by.begin(), by.end(), [&](const auto& b) { return !gone[b.first] && b.second[k]; });
    return points ? static_cast<double>(covered) / static_cast<double>(points) : 0;
  }
  /// The part that covers most.
  std::size_t worst(const std::vector<char>& gone) const {
    std::size_t best = 0;
    std::ptrdiff_t most = -1;
    for (const auto& [other, mask] : by) {
      const auto n = std::count(mask.begin(), mask.end(), 1);
      if (!gone[other] && n > most) {
        most = n;
        best = other;
      }
    }
    return best;
  }
};

}  // namespace

Dropped find_duplicates(const std::vector<Candidate>& candidates, const RunContext& context) {
  Dropped dropped;
  std::vector<char> gone(candidates.size(), 0);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    stop_if_asked(context, "looking for duplicates");
    for (std::size_t j = 0; j < i; ++j) {
      if (gone[j] || !same_place(candidates[j], candidates[i])) continue;
      gone[i] = 1;
      dropped.emplace_back(i, fmt::format("duplicate: same geometry and place as '{}'", candidates[j].name));
      break;
    }
  }
  return dropped;
}

Dropped find_overlapping(const std::vector<Candidate>& candidates, double max_share, const RunContext& context) {
  std::vector<std::unique_ptr<TriangleBvh>> bvhs(candidates.size());
  const auto name = [&](std::size_t i) { return candidates[i].name; };
  parallel_phase(
      candidates.size(), context, "overlap shares",
      [&](std::size_t i) { bvhs[i] = candidates[i].bvh(); }, name);
  std::vector<Coverage> coverage(candidates.size());
  parallel_phase(
      candidates.size(), context, "overlap shares",
      [&](std::size_t i) {
        const Aabb& box = candidates[i].box;
        std::vector<std::size_t> others;
        for (std::size_t j = 0; j < candidates.size(); ++j)
          if (j != i && box.overlaps(candidates[j].box)) others.push_back(j);
        if (others.empty()) return;
        Rng rng = Rng(0x6F7665726C6170ull).fork(i);  // separate, so that the assembly does not depend on the run's seed
        std::vector<Eigen::Vector3d> points;
        // 2000 points give a share to about 1 %; the limit on tries is for parts that fill little of their box.
        for (std::size_t k = 0; k < 800'000 && points.size() < 2000 && !context.should_stop(); ++k) {
          Eigen::Vector3d p;
          for (int d = 0; d < 3; ++d) p[d] = rng.uniform(box.lo[d], box.hi[d]);
          if (bvhs[i]->inside(p)) points.push_back(p);
        }
        coverage[i].points = points.size();
        for (const auto j : others) {
          std::vector<char> mask(points.size());
          for (std::size_t k = 0; k < points.size(); ++k)
            mask[k] = candidates[j].box.contains(points[k]) && bvhs[j]->inside(points[k]);
          if (std::find(mask.begin(), mask.end(), 1) != mask.end()) coverage[i].by.emplace_back(j, std::move(mask));
        }
      },
      name);
  std::vector<char> gone(candidates.size(), 0);
  Dropped dropped;
  for (;;) {
    // Drop the worst first: the others may then be within the limit.
    std::size_t worst = candidates.size();
    double worst_share = max_share;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (gone[i]) continue;
      const double share = coverage[i].share(gone);
      if (share > worst_share ||
          (worst < candidates.size() && share == worst_share && candidates[i].volume < candidates[worst].volume)) {
        worst = i;
        worst_share = share;
      }
    }
    if (worst == candidates.size()) break;
    dropped.emplace_back(worst,
                         fmt::format("{:.1f} % of its volume is inside other parts, most of that in '{}'; the "
                                     "limit is {:.4g} % (assembly.max_overlap)",
                                     100 * worst_share, candidates[coverage[worst].worst(gone)].name, 100 * max_share));
    gone[worst] = 1;
  }
  std::sort(dropped.begin(), dropped.end());
  return dropped;
}

Dropped find_thin(const std::vector<Candidate>& candidates, double min_thickness, const RunContext& context) {
  const double limit = min_thickness * box_of(candidates).size().maxCoeff();
  std::vector<double> thickness(candidates.size());
  parallel_phase(
      candidates.size(), context, "oriented boxes",
      [&](std::size_t i) { thickness[i] = oriented_box(candidates[i].mesh)[0]; },
      [&](std::size_t i) { return candidates[i].name; });
  Dropped dropped;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (thickness[i] < limit)
      dropped.emplace_back(i,
                           fmt::format("thin: its oriented box is {:.4g} thick, the limit is {:.4g}, {:.4g} % of the "
                                       "assembly (assembly.min_thickness)",
                                       thickness[i], limit, 100 * min_thickness));
  return dropped;
}

std::vector<std::vector<std::size_t>> connected_groups(const std::vector<Candidate>& candidates, double gap,
                                                       const RunContext& context) {
  std::vector<std::vector<Eigen::Vector3d>> hulls(candidates.size());
  parallel_phase(
      candidates.size(), context, "hulls", [&](std::size_t i) { hulls[i] = hull_corners(candidates[i].mesh.vertices); },
      [&](std::size_t i) { return candidates[i].name; });
  DisjointSets sets(candidates.size());
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    stop_if_asked(context, "looking for connected parts");
    Aabb reach = candidates[i].box;
    reach.inflate(gap);
    for (std::uint32_t j = 0; j < i; ++j)
      if (sets.root(i) != sets.root(j) && reach.overlaps(candidates[j].box) && !separate(hulls[i], hulls[j], gap))
        sets.join(i, j);
  }
  std::vector<std::vector<std::size_t>> by_root(candidates.size()), groups;
  for (std::uint32_t i = 0; i < candidates.size(); ++i) by_root[sets.root(i)].push_back(i);
  for (auto& group : by_root)
    if (!group.empty()) groups.push_back(std::move(group));
  std::stable_sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return groups;
}

Aabb box_of(const std::vector<Candidate>& candidates) {
  Aabb box;
  for (const auto& c : candidates) box.extend(c.box);
  return box;
}

}  // namespace dismantle
