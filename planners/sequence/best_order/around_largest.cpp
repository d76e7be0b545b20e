#include "best_order/around_largest.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "best_order/rewrite.h"
#include "blocking_graph/graph.h"
#include "dismantle/part_set.h"

namespace dismantle::order {

namespace {

using Eigen::Vector3d;

/// By the volume of its box. None: another part is as large.
std::optional<PartId> largest_part(const SequenceQuery& query) {
  std::optional<PartId> largest;
  double most = 0;
  for (const auto& group : query.start)
    for (const PlacedPart& p : group) {
      const double size = query.assembly.parts[p.part].mesh->box().size().prod();
      constexpr double kAlike = 1e-6;
      if (size > (1 + kAlike) * most)
        largest = p.part;
      else if (size > (1 - kAlike) * most)
        largest.reset();
      most = std::max(most, size);
    }
  return largest;
}

std::optional<std::size_t> direction_of(const Path& path, const blocking::Directions& directions) {
  const Vector3d out = path.back().front().t - path.front().front().t;
  if (!is_straight(path)) return std::nullopt;
  for (std::size_t d = 0; d < directions.all.size(); ++d)
    if (directions.all[d].dot(out) > (1 - 1e-9) * out.norm()) return d;
  return std::nullopt;
}

class AroundLargest {
 public:
  AroundLargest(OrderScene& scene, PartId largest)
      : scene_(scene),
        query_(scene.query),
        largest_(largest),
        kept_(kept_sets(query_.assembly.parts.size(), query_.constraints)),
        now_(query_.assembly.parts.size(), query_.start) {}

  std::vector<Removal> of(const std::vector<Removal>& plan) {
    Disassembly before(query_.assembly.parts.size(), query_.start);
    for (const Removal& removal : plan) {
      const std::size_t group = before.group(removal.parts.front());
      const std::vector<PartId> rest = without(before.groups()[group], removal.parts);
      const bool possible = contains(removal.parts, largest_) ? others_leave(removal, rest) : adopt(removal);
      if (!possible || scene_.context.should_stop()) return {};
      before.add(step_of(removal));
    }
    const auto count = [](const Disassembly& d) {
      return std::count_if(d.groups().begin(), d.groups().end(), [](const auto& g) { return !g.empty(); });
    };
    return turned_ && count(before) == count(now_) ? result_ : std::vector<Removal>{};
  }

 private:
  bool add(const Removal& removal) {
    if (removal.parts.empty()) return false;
    const std::size_t group = now_.group(removal.parts.front());
    if (!may_leave(removal.parts, without(now_.groups()[group], removal.parts), query_.constraints)) return false;
    now_.add(step_of(removal));
    result_.push_back(removal);
    return true;
  }

  /// A step of the first plan, if what it takes out is still with others.
  bool adopt(const Removal& removal) {
    if (!turned_) return add(removal);
    std::set<std::size_t> groups;
    for (const PartId part : removal.parts) groups.insert(now_.group(part));
    std::size_t parts = 0;
    for (const std::size_t g : groups) parts += now_.groups()[g].size();
    if (parts == removal.parts.size()) return true;  // each of these groups has left
    if (groups.size() > 1 || !is_plain(removal)) return false;
    std::vector<PartId> blocked_by;
    return add(verified({&removal, nullptr, kNone}, now_, scene_, blocked_by));
  }

  /// `removal` takes the largest part away from `rest`.
  bool others_leave(const Removal& removal, const std::vector<PartId>& rest) {
    if (!is_plain(removal)) return false;
    const std::optional<std::size_t> out = direction_of(removal.attempt->path(), scene_.directions);
    if (!out) return false;
    turned_ = true;
    std::map<PartId, std::vector<PartId>> units;
    for (const PartId part : rest)
      if (now_.group(part) == now_.group(largest_)) units[kept_[part]].push_back(part);
    std::vector<std::vector<PartId>> nodes;
    for (auto& [first, parts] : units) nodes.push_back(std::move(parts));
    while (!nodes.empty()) {
      const auto left = smallest_groups(nodes, blocking::Directions::opposite(*out));
      if (!left) return false;
      std::vector<bool> gone(nodes.size(), false);
      for (const std::vector<std::size_t>& group : *left) {
        std::vector<PartId> parts;
        for (const std::size_t k : group) {
          parts.insert(parts.end(), nodes[k].begin(), nodes[k].end());
          gone[k] = true;
        }
        std::sort(parts.begin(), parts.end());
        if (!add(straight_out(std::move(parts), blocking::Directions::opposite(*out), removal.up, now_, scene_)))
          return false;
      }
      std::vector<std::vector<PartId>> later;
      for (std::size_t k = 0; k < nodes.size(); ++k)
        if (!gone[k]) later.push_back(std::move(nodes[k]));
      nodes = std::move(later);
    }
    return true;
  }

  /// Groups of nodes that can move along the direction before all others. None: the effort is spent.
  std::optional<std::vector<std::vector<std::size_t>>> smallest_groups(const std::vector<std::vector<PartId>>& nodes,
                                                                       std::size_t direction) {
    bool spent = false;
    blocking::Orientations orientations;
    for (const auto& node : nodes)
      for (const PartId part : node) orientations.number_of(now_.pose(part).q);
    blocking::Relations relations(*scene_.sweep, scene_.directions, orientations, scene_.context.executor);
    const auto blocks = [&](PartId a, PartId b) {
      const Pose &at = now_.pose(a), &other = now_.pose(b);
      const blocking::Pair pair{
          a, b, direction, at.t - other.t, orientations.number_of(at.q), orientations.number_of(other.q)};
      if (relations.far(pair)) return false;
      spent = spent || (!relations.known(pair) && !scene_.sweeps.spend());
      return spent || relations.blocks(pair);
    };
    auto groups = blocking::free_groups(
        nodes.size(),
        [&](std::size_t node, const std::function<bool(std::size_t)>& inside) -> std::optional<std::size_t> {
          for (std::size_t other = 0; other < nodes.size(); ++other) {
            if (other == node || inside(other)) continue;
            for (const PartId a : nodes[node])
              for (const PartId b : nodes[other])
                if (blocks(a, b)) return other;
          }
          return std::nullopt;
        });
    if (spent) return std::nullopt;
    if (groups.empty()) {  // only all together
      groups.emplace_back();
      for (std::size_t k = 0; k < nodes.size(); ++k) groups.back().push_back(k);
    }
    return groups;
  }

  OrderScene& scene_;
  const SequenceQuery& query_;
  PartId largest_;
  std::vector<PartId> kept_;
  Disassembly now_;
  std::vector<Removal> result_;
  bool turned_ = false;
};

}  // namespace

std::vector<Removal> around_largest(const std::vector<Removal>& plan, OrderScene& scene) {
  if (scene.sweep == nullptr || !scene.query.constraints.base.empty()) return {};
  const std::optional<PartId> largest = largest_part(scene.query);
  return largest ? AroundLargest(scene, *largest).of(plan) : std::vector<Removal>{};
}

}  // namespace dismantle::order
