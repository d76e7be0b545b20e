#include "least_cut/forced_motions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "dismantle/geometry/boxes_along.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/part_data.h"
#include "dismantle/geometry/ray.h"
#include "dismantle/geometry/slippage.h"
#include "dismantle/geometry/swept_boxes.h"

namespace dismantle::least_cut {

namespace {

using Vec3 = Eigen::Vector3d;

/// Spread evenly over the sphere (Fibonacci lattice).
std::vector<Vec3> sphere(unsigned count) {
  std::vector<Vec3> points;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (unsigned i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(std::max(0.0, 1 - z * z));
    points.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  return points;
}

std::vector<Aabb> boxes_of(const Assembly& assembly) {
  std::vector<Aabb> boxes;
  for (const Part& part : assembly.parts) boxes.push_back(part.mesh->box());
  return boxes;
}

}  // namespace

bool more_promising(const ForcedMotion& a, const ForcedMotion& b) {
  if (a.thickness != b.thickness) return a.thickness < b.thickness;
  return a.duration * a.twist.linear.norm() < b.duration * b.twist.linear.norm();
}

ForcedMotions::ForcedMotions(const Assembly& assembly, PathOracle& oracle, const Constraints& constraints,
                             const LeastCutParameters& params)
    : assembly_(assembly),
      oracle_(oracle),
      constraints_(constraints),
      params_(params),
      axes_(assembly.parts.size()),
      turns_(assembly.parts.size()),
      boxes_(boxes_of(assembly)),
      blockers_(
          boxes_, [this](const PlacedPart& p, const Vec3& along) { return reach(p, along); },
          [this](const PlacedPart& p, const PlacedPart& q, const Vec3& along) {
            return known(p, q, along).thickness;
          }) {}

const std::vector<geometry::FaceAxis>& ForcedMotions::axes(PartId part) {
  std::vector<geometry::FaceAxis>& known = axes_.at(part);
  if (!known.empty()) return known;
  const Mesh& mesh = *assembly_.parts.at(part).mesh;
  std::vector<geometry::FaceAxis> faces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 area = geometry::area_vector(mesh, t);
    if (area.norm() > 0) faces.push_back({area.normalized(), 0.5 * area.norm()});
  }
  known = geometry::rounded_axes(faces);
  geometry::sort_by_area(known, params_.part_axes);
  // A round part need not have a face along its axis, so its axis is added, with an area that puts it first.
  for (const geometry::Twist& t : turns(part))
    geometry::add_face(known, {t.angular.normalized(), std::numeric_limits<double>::max()}, geometry::kSameDirection);
  return known;
}

/// Slippable motions with a rotation: those of round parts and of threads.
const std::vector<geometry::Twist>& ForcedMotions::turns(PartId part) {
  std::optional<std::vector<geometry::Twist>>& known = turns_.at(part);
  if (known) return *known;
  known.emplace();
  const Mesh& mesh = *assembly_.parts.at(part).mesh;
  for (const geometry::Twist& t : geometry::slippable_motions(mesh, mesh.box().center()))
    if (!t.angular.isZero()) known->push_back(t);
  return *known;
}

/// Sets of parts that the constraints keep together; each leaves as one piece.
std::vector<Placed> ForcedMotions::units(const Placed& group) const {
  const std::vector<PartId> set = kept_sets(assembly_.parts.size(), constraints_);
  std::vector<Placed> list;
  for (const PlacedPart& p : group) {
    const auto same = std::find_if(list.begin(), list.end(),
                                   [&](const Placed& unit) { return set[unit.front().part] == set[p.part]; });
    if (same == list.end())
      list.push_back({p});
    else
      same->push_back(p);
  }
  return list;
}

/// Do the constraints allow these parts to leave the group now?
bool ForcedMotions::allowed(const Placed& moving, const Placed& group) const {
  if (moving.empty() || moving.size() == group.size()) return false;
  return may_leave(ids_of(moving), ids_of(without(group, moving)), constraints_);
}

std::vector<ForcedMotions::Direction> ForcedMotions::directions(const Placed& group, Variety variety) {
  std::vector<geometry::FaceAxis> lines;
  for (const PlacedPart& p : group)
    for (const geometry::FaceAxis& a : axes(p.part))
      geometry::add_face(lines, {p.pose.q * a.axis, a.area}, geometry::kSameDirection);
  geometry::sort_by_area(lines, variety == Variety::all ? params_.group_axes : params_.quick_axes);
  for (int k = 0; k < 3; ++k) geometry::add_face(lines, {Vec3::Unit(k), 0}, geometry::kSameDirection);
  std::vector<Direction> list;
  for (const geometry::FaceAxis& a : lines) {
    list.push_back({a.axis.normalized()});
    list.push_back({-a.axis.normalized()});
  }
  if (variety == Variety::all)
    for (const Vec3& d : sphere(params_.directions)) list.push_back({d, true});
  return list;
}

/// Along the axes of the parts of the unit, except those that are listed.
std::vector<Vec3> ForcedMotions::own_directions(const Placed& unit, const std::vector<Direction>& listed) {
  std::vector<Vec3> list;
  for (const PlacedPart& p : unit)
    for (const geometry::FaceAxis& a : axes(p.part))
      for (const double sign : {1.0, -1.0}) {
        const Vec3 d = sign * (p.pose.q * a.axis).normalized();
        const auto same = [&](const Vec3& other) { return d.dot(other) > geometry::kSameDirection; };
        const auto same_feature = [&](const Direction& other) { return !other.sampled && same(other.along); };
        if (std::none_of(listed.begin(), listed.end(), same_feature) && std::none_of(list.begin(), list.end(), same))
          list.push_back(d);
      }
  return list;
}

ForcedMotions::Known& ForcedMotions::known(const PlacedPart& moving, const PlacedPart& fixed, const Vec3& along) {
  const auto [at, is_new] = known_.try_emplace({moving.part, fixed.part, rounded_direction(along)});
  Known& entry = at->second;
  if (!is_new && entry.moving == moving.pose && entry.fixed == fixed.pose) return entry;
  entry = {moving.pose, fixed.pose};
  send_rays(moving, fixed, along, entry);
  return entry;
}

const ForcedMotions::Known& ForcedMotions::blocking(const PlacedPart& moving, const PlacedPart& fixed,
                                                    const Vec3& along) {
  static const Known kNotBlocking;
  const Aabb a = geometry::box_under(boxes_[moving.part], moving.pose);
  return geometry::meets_along(a, geometry::box_under(boxes_[fixed.part], fixed.pose), along)
             ? known(moving, fixed, along)
             : kNotBlocking;
}

const std::vector<geometry::Solid>& ForcedMotions::solids(PartId part) const {
  return geometry::solids_of(assembly_, part, *oracle_.memo(), oracle_.tolerance());
}

const std::vector<Vec3>& ForcedMotions::hull(PartId part) const {
  return geometry::hull_of(assembly_, part, *oracle_.memo());
}

/// Largest of along * x over the hull.
double ForcedMotions::reach(const PlacedPart& part, const Vec3& along) const {
  double most = -std::numeric_limits<double>::infinity();
  for (const Vec3& c : hull(part.part)) most = std::max(most, along.dot(part.pose * c));
  return most;
}

/// Test by boxes alone: may `moving` meet `fixed` on its way?
bool ForcedMotions::in_reach(const PlacedPart& moving, const PlacedPart& fixed, const Vec3& along,
                             double distance) const {
  const geometry::SweptBoxes swept({moving.pose, {moving.pose.t + distance * along, moving.pose.q}},
                                   boxes_[moving.part]);
  return swept.meets(geometry::SweptBoxes({fixed.pose}, boxes_[fixed.part]), 0);
}

/// Sends rays along the motion from `moving`, and against it from `fixed`; stores the share that enters the other part
/// and the mean length inside it. A surface that starts slightly inside the other and slides along it does not enter
/// it.
void ForcedMotions::send_rays(const PlacedPart& moving, const PlacedPart& fixed, const Vec3& along,
                              Known& entry) const {
  const double skin = oracle_.tolerance() + assembly_.initial_overlap(moving.part, fixed.part);
  const double distance = reach(fixed, along) + reach(moving, -along);
  if (distance <= skin) return;
  if (!in_reach(moving, fixed, along, distance)) return;
  const auto send = [&](const PlacedPart& from, const PlacedPart& to, const Vec3& d) {
    const auto& vertices = assembly_.parts[from.part].mesh->vertices;
    const std::size_t stride = std::max<std::size_t>(1, vertices.size() / params_.rays);
    std::size_t rays = 0, hits = 0;
    double length = 0;
    for (std::size_t v = 0; v < vertices.size(); v += stride, ++rays) {
      const Vec3 x = from.pose * vertices[v];
      for (const geometry::Solid& solid : solids(to.part)) {
        const Pose back = (to.pose * solid.frame).inverse();
        const Vec3 start = back * x, local = back.q * d;
        const auto enters = [&](std::uint32_t t) { return solid.normals[t].dot(local) < 0; };
        const auto leaves = [&](std::uint32_t t) { return solid.normals[t].dot(local) > 0; };
        const double in = geometry::first_hit(solid.bvh, start, local, distance, enters);
        if (!std::isfinite(in)) continue;
        ++hits;
        const double out = geometry::first_hit(solid.bvh, start + in * local, local, distance, leaves);
        if (std::isfinite(out)) length += out;
        break;
      }
    }
    const double count = static_cast<double>(std::max<std::size_t>(1, rays));
    entry.blocked = std::max(entry.blocked, static_cast<double>(hits) / count);
    entry.thickness = std::max(entry.thickness, length / count);
  };
  send(moving, fixed, along);
  send(fixed, moving, -along);
}

ForcedMotion ForcedMotions::straight(const Placed& moving, const Placed& group, const Vec3& along) {
  ForcedMotion m{moving, without(group, moving), {along, Vec3::Zero()}, Vec3::Zero(), 0, 0};
  m.duration = distance_apart(m, along);
  m.thickness = thickness(m, along);
  return m;
}

/// How far the moving parts have to go until the hulls of both sides are apart.
double ForcedMotions::distance_apart(const ForcedMotion& motion, const Vec3& along) const {
  double front = -std::numeric_limits<double>::infinity(), behind = front;
  for (const PlacedPart& p : motion.fixed) front = std::max(front, reach(p, along));
  for (const PlacedPart& p : motion.moving) behind = std::max(behind, reach(p, -along));
  return std::max(0.0, front + behind) + params_.clearance * oracle_.tolerance();
}

/// As ForcedMotion::thickness.
double ForcedMotions::thickness(const ForcedMotion& motion, const Vec3& along) {
  double sum = 0;
  for (const PlacedPart& p : motion.moving)
    for (const PlacedPart& q : motion.fixed) sum += blocking(p, q, along).thickness;
  return sum;
}

/// Adds the unit alone, with all that blocks it, and with only what blocks it firmly.
void ForcedMotions::add_straight(const Placed& unit, const std::vector<Placed>& all, const Placed& group,
                                 const Direction& direction, std::vector<ForcedMotion>& list,
                                 const RunContext& context) {
  const Vec3& along = direction.along;
  std::vector<Placed> sets{unit};
  for (const double most : {params_.blocking_share, params_.firm_share}) {
    std::vector<bool> moves(all.size(), false);
    std::vector<std::size_t> open;
    for (std::size_t k = 0; k < all.size(); ++k)
      if (contains(unit, all[k].front().part)) {
        moves[k] = true;
        open.push_back(k);
      }
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (context.should_stop()) return;
      for (std::size_t other = 0; other < all.size(); ++other) {
        if (moves[other]) continue;
        double share = 0;
        for (const PlacedPart& p : all[open[k]])
          for (const PlacedPart& q : all[other]) share = std::max(share, blocking(p, q, along).blocked);
        if (share <= most) continue;
        moves[other] = true;
        open.push_back(other);
      }
    }
    if (open.size() == all.size()) continue;
    Placed set;
    std::copy_if(group.begin(), group.end(), std::back_inserter(set), [&](const PlacedPart& p) {
      return std::any_of(open.begin(), open.end(), [&](std::size_t k) { return contains(all[k], p.part); });
    });
    sets.push_back(std::move(set));
  }
  for (const Placed& set : sets) {
    if (!allowed(set, group)) continue;
    const bool listed = std::any_of(list.begin(), list.end(), [&](const ForcedMotion& m) {
      return m.twist.linear == along && ids_of(m.moving) == ids_of(set);
    });
    if (listed) continue;
    list.push_back(straight(set, group, along));
    list.back().sampled = direction.sampled;
  }
}

void ForcedMotions::add_screws(const Placed& unit, const Placed& group, std::vector<ForcedMotion>& list) {
  if (unit.size() != 1 || !allowed(unit, group)) return;
  const PlacedPart& part = unit.front();
  for (const geometry::Twist& screw : turns(part.part)) {
    for (const double sign : {1.0, -1.0}) {
      ForcedMotion m;
      m.moving = unit;
      m.fixed = without(group, unit);
      m.center = part.pose * assembly_.parts[part.part].mesh->box().center();
      m.twist = {sign * (part.pose.q * screw.linear), sign * (part.pose.q * screw.angular)};
      const Vec3 axis = m.twist.angular.normalized();
      const double speed = axis.dot(m.twist.linear);
      const Vec3 along = speed > 0 ? axis : Vec3(-axis);
      m.duration = distance_apart(m, along) / std::abs(speed);  // infinite for a pure rotation
      if (!(m.duration * m.twist.angular.norm() <= 2 * std::numbers::pi * params_.max_turns)) continue;
      m.thickness = thickness(m, along);
      list.push_back(std::move(m));
    }
  }
}

std::vector<ForcedMotion> ForcedMotions::candidates(const Placed& group, const RunContext& context) {
  const std::vector<Placed> all = units(group);
  std::vector<ForcedMotion> list;
  const std::vector<Direction> shared = directions(group, Variety::all);
  for (const Direction& d : shared)
    for (const Placed& unit : all) {
      if (context.should_stop()) break;
      add_straight(unit, all, group, d, list, context);
    }
  for (const Placed& unit : all) {
    if (context.should_stop()) break;
    // In a large group the axes of small parts are not among those of the group.
    for (const Vec3& d : own_directions(unit, shared)) add_straight(unit, all, group, {d}, list, context);
    add_screws(unit, group, list);
  }
  std::stable_sort(list.begin(), list.end(), more_promising);
  return list;
}

std::optional<ForcedMotion> ForcedMotions::quick_candidate(const Placed& group, const RunContext& context) {
  std::vector<Placed> leaving = units(group);
  std::erase_if(leaving, [&](const Placed& unit) { return !allowed(unit, group); });
  blockers_.set_group(group);
  struct Candidate {
    const Placed* unit;
    std::size_t direction;
    double length;
  };
  const std::vector<Direction> directions = this->directions(group, Variety::few);
  std::vector<DirectionalBlockers::Along> along;
  std::vector<Candidate> candidates;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    along.push_back(blockers_.along(directions[d].along));
    for (const Placed& unit : leaving) candidates.push_back({&unit, d, along.back().length(unit)});
    if (context.should_stop()) return std::nullopt;
  }
  // Of equal thickness the shortest is the best. The search ends at the first candidate that is not blocked.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.length < b.length; });
  const Candidate* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : candidates) {
    if (context.should_stop()) return std::nullopt;
    const double thickness = along[candidate.direction].thickness(*candidate.unit);
    if (best != nullptr && thickness >= least) continue;
    best = &candidate;
    least = thickness;
    if (least == 0) break;
  }
  if (best == nullptr) return std::nullopt;
  return straight(*best->unit, group, directions[best->direction].along);
}

Path ForcedMotions::path(const ForcedMotion& motion) const {
  // The screw motion between two poses is unique below half a turn; an eighth of that leaves a margin.
  const double max_turn = std::numbers::pi / 8;
  const double turn = motion.duration * motion.twist.angular.norm();
  const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(turn / max_turn)));
  Path path;
  for (std::size_t k = 0; k <= steps; ++k) {
    const double t = motion.duration * static_cast<double>(k) / static_cast<double>(steps);
    std::vector<Pose> instant;
    for (const PlacedPart& p : motion.moving)
      instant.push_back(k == 0              ? p.pose
                        : motion.straight() ? Pose{p.pose.t + t * motion.twist.linear, p.pose.q}
                                            : geometry::moved_along(p.pose, motion.twist, motion.center, t));
    path.push_back(std::move(instant));
  }
  return path;
}

}  // namespace dismantle::least_cut
