// One pass over the points of a member that may touch another member.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "dismantle/sdf/contact_scene.h"

namespace dismantle::sdf {
namespace {

/// Beyond this many margins a bound of the distance is sufficient.
constexpr double kFarEnough = 2;
/// Wake value of a block with a point within the margin: wakes immediately.
const double held_block = -std::numeric_limits<double>::infinity();

/// Error of the motion from an anchor and of its distance, both stored in single precision.
double rounding_of(const Anchor& anchor) {
  return std::numeric_limits<float>::epsilon() * (anchor.point.lpNorm<1>() + std::abs(anchor.distance));
}

/// True if p is in a region where the distance is known to be linear.
bool is_linear_at(const DirectedContacts& set, std::uint32_t place, const Eigen::Vector3d& p) {
  if (place == 0) return false;
  const LinearDistance& known = set.known[place - 1];
  return (p - known.point).squaredNorm() < known.squared_radius;
}

bool recall(const DirectedContacts& set, const SurfaceQuery& surface, std::uint32_t place, const Eigen::Vector3d& p,
            Sample& sample) {
  if (!is_linear_at(set, place, p)) return false;
  const LinearDistance& known = set.known[place - 1];
  sample.value = surface.plane_distance(p, known.triangle);
  sample.normal = known.normal;
  sample.triangle = known.triangle;
  sample.flat_radius = std::sqrt(known.squared_radius) - (p - known.point).norm();
  return true;
}

void remember(DirectedContacts& set, std::uint32_t& place, const Eigen::Vector3d& p, const Sample& sample) {
  if (place == 0) {
    set.known.emplace_back();
    place = static_cast<std::uint32_t>(set.known.size());
  }
  set.known[place - 1] = {p, sample.normal, sample.flat_radius * sample.flat_radius, sample.triangle};
}

}  // namespace

Sample ContactScene::signed_distance(const SolidField& field, const Eigen::Vector3d& p, double limit,
                                     const FlatnessWanted& flatness, std::uint32_t& hint, const Near& near) {
  ++queries_;
  // A query with the last closest triangle needs no bound.
  if (near.surely && hint != geometry::kNoIndex) {
    const Sample s = field.surface->sample(p, limit, hint, flatness, near.list);
    hint = s.triangle;
    return s;
  }
  Sample rough;
  if (model_ == DistanceModel::grid) {
    rough.value = field.grid->value(p, rough.normal);
    return rough;
  }
  // If the point is clearly far, a bound from the grid or from finer cells suffices. Else the grid limits the search.
  const double enough = kFarEnough * margin_;
  double bound = field.grid->lower_bound(p);
  if (bound <= enough) bound = std::max(bound, field.surface->lower_bound(p, hint, near.list));
  rough.value = std::min(bound, limit);
  if (bound > enough) return rough;
  const double first =
      hint == geometry::kNoIndex ? std::min(limit, std::abs(field.grid->value(p)) + field.grid->cell().norm()) : limit;
  Sample s = field.surface->sample(p, first, hint, flatness, near.list);
  if (s.triangle == geometry::kNoIndex && first < limit) s = field.surface->sample(p, limit, hint, flatness);
  if (s.triangle != geometry::kNoIndex) {
    hint = s.triangle;
    return s;
  }
  // Nothing within the limit: far outside or deep inside, which only the grid can distinguish.
  rough.value = limit;
  if (field.box.contains(p)) {
    const double inside = field.grid->value(p, rough.normal);
    // Where the grid cannot decide inside or outside, query the triangles.
    if (std::abs(inside) <= 2 * field.grid->error_near()) return field.surface->sample(p);
    if (inside < 0) rough.value = std::min(inside, -limit);
  }
  return rough;
}

/// Prefetches the data for the distances of all points together. Points with linear distance need none.
void ContactScene::find_lists(const SurfaceQuery& surface, const DirectedContacts& set, std::span<AwakePoint> points) {
  std::array<Eigen::Vector3d, SurfaceQuery::kMostPrefetched> at;
  std::array<std::uint32_t, SurfaceQuery::kMostPrefetched> asked, hints;
  std::array<const CandidateList*, SurfaceQuery::kMostPrefetched> lists;
  std::size_t count = 0;
  for (std::uint32_t n = 0; n < points.size(); ++n) {
    if (points[n].linear) continue;
    at[count] = points[n].at;
    hints[count] = set.hint[points[n].index];
    asked[count++] = n;
  }
  surface.prefetch({at.data(), count}, {hints.data(), count}, {lists.data(), count});
  for (std::size_t n = 0; n < count; ++n) points[asked[n]].near.list = lists[n];
}

/// A pass over the points of `owner`: lists those that are nearer to the solids of `surface` than the margin.
struct ContactScene::Scan {
  /// The smallest distance of a point from the solids.
  struct Touch {
    double distance = 0;
    std::size_t solid = 0;
    Sample sample;
  };

  Scan(ContactScene& scene_, const ContactPair& pair_, DirectedContacts& set_, std::uint32_t owner_,
       std::uint32_t surface_, double odometer_, std::vector<ContactPoint>& out_)
      : scene(scene_),
        pair(pair_),
        set(set_),
        owner(owner_),
        surface(surface_),
        odometer(odometer_),
        out(out_),
        points(scene_.members_[owner_].placed->shape->points),
        target(*scene_.members_[surface_].placed->shape) {
    const Pose to_target = scene.world_[surface].inverse() * scene.world_[owner];
    rotation = to_target.q.toRotationMatrix();
    shift = to_target.t;
    to_world = scene.world_[surface].q.toRotationMatrix();
  }

  void prepare();
  void collect();
  double free_above(std::uint32_t block, const Eigen::Vector3d& center) const;
  double collect_points(std::uint32_t block);
  void measure();
  void measure_point(const AwakePoint& point);
  void measure_extra();
  Touch nearest(const Eigen::Vector3d& p, std::uint32_t* hint, std::uint32_t* linear, double allowed, const Near& near);
  void list(const Eigen::Vector3d& p, const Touch& touch, double allowed);
  void list_surroundings(const Eigen::Vector3d& p, const Touch& touch, ContactPoint c);
  /// Depth allowed to a point; `own`: see DirectedContacts, read only if points have allowances of their own.
  double allowance(const std::vector<float>& own, std::size_t point) const {
    return local ? std::max<double>(pair.everywhere, own[point]) : pair.everywhere;
  }

  ContactScene& scene;
  const ContactPair& pair;
  DirectedContacts& set;
  const std::uint32_t owner, surface;
  const double odometer;
  std::vector<ContactPoint>& out;
  const ContactPoints& points;
  const Shape& target;
  const std::size_t solids = target.solids.size();
  const double margin = scene.margin_;
  /// A bound above this replaces the distance; below it, distances were measured on triangles.
  const double near_enough = kFarEnough * margin;
  const bool local = pair.everywhere < pair.allowed;  ///< points have allowances of their own
  const bool exact = scene.model_ == DistanceModel::exact;
  const bool single = exact && solids == 1;
  Eigen::Matrix3d rotation, to_world;  ///< frame of the owner -> frame of the surface -> world
  Eigen::Vector3d shift;
};

void ContactScene::Scan::prepare() {
  if (set.ready) return;
  const std::size_t count = points.points.size();
  set.wake.assign(points.blocks.size(), -1.0);
  set.point_wake.assign(count, -1.0);
  set.anchor.assign(count, {});
  set.hint.assign(count * solids, geometry::kNoIndex);
  set.linear.assign(count * solids, 0);
  if (local) scene.measure_own_depths(pair, set, scene.members_[owner], scene.members_[surface]);
  set.ready = true;
}

/// Collects the points that may be near. Their distances are measured together, so that memory accesses overlap.
void ContactScene::Scan::collect() {
  scene.awake_.clear();
  for (std::uint32_t k = 0; k < points.blocks.size(); ++k) {
    if (set.wake[k] > odometer) continue;
    const double lower = free_above(k, rotation * points.blocks[k].center + shift);
    // With a bound of zero the block may be inside, at any depth.
    double slack = lower > 0 ? lower + pair.everywhere - margin : -1.0;
    if (!(slack > 0)) slack = collect_points(k);
    set.wake[k] = odometer + slack;  // for awake points: set in measure_point()
  }
}

/// Lower bound of the distances of the points of a block; none if it is not above 0. `center`: of the block, in the
/// frame of the surface.
double ContactScene::Scan::free_above(std::uint32_t block, const Eigen::Vector3d& center) const {
  // If a point was listed, a bound for the whole block is of no use yet.
  if (set.wake[block] == held_block) return 0;
  const double radius = points.blocks[block].radius;
  const double lower = std::sqrt(target.box.squared_distance(center)) - radius;
  if (!(lower + pair.everywhere < margin)) return lower;
  double free = 4 * scene.reach_;
  for (const SolidField& s : target.solids) {
    const double outside = std::sqrt(s.box.squared_distance(center));
    free = std::min(free, std::max(outside, s.grid->lower_bound(center)));
  }
  return std::max(lower, free - radius);
}

/// Returns how far the bodies may move before one of the other points of the block can be near.
double ContactScene::Scan::collect_points(std::uint32_t block) {
  // Copies, because the compiler has to assume that the stores below change members.
  const Eigen::Matrix3d turn = rotation;
  const Eigen::Vector3d from = shift;
  const double now = odometer, everywhere = pair.everywhere, limit = margin;
  const Eigen::Vector3d* const at = points.points.data();
  const Anchor* const anchors = set.anchor.data();
  double* const wake = set.point_wake.data();
  double slack = scene.reach_;
  const std::uint32_t first = points.blocks[block].first, end = first + points.blocks[block].count;
  for (std::uint32_t i = first; i < end; ++i) {
    if (wake[i] > now) {
      slack = std::min(slack, wake[i] - now);
      continue;
    }
    AwakePoint point{i, block, false, turn * at[i] + from, {}};
    // The odometer bounds the motion of all points; this point may have moved less and still be far enough away.
    if (const Anchor& anchor = anchors[i]; anchor.is_known()) {
      const double moved = (point.at - anchor.point.cast<double>()).norm() + rounding_of(anchor);
      const double beyond = anchor.distance - moved + everywhere - limit;
      if (beyond > 0) {
        wake[i] = now + beyond;
        slack = std::min(slack, beyond);
        continue;
      }
      point.near.surely = single && std::abs(anchor.distance) + moved < near_enough;
      // If a point keeps moving as far as before, it leaves any smaller radius. Surroundings need all radii.
      if (!scene.surroundings_) point.near.moved = moved;
    }
    point.linear = is_linear_at(set, set.linear[i * solids], point.at);
    scene.awake_.push_back(point);
  }
  return slack;
}

/// Measures the distances of the collected points and lists those within the margin.
void ContactScene::Scan::measure() {
  const std::span awake(scene.awake_);
  for (std::size_t begin = 0; begin < awake.size(); begin += SurfaceQuery::kMostPrefetched) {
    const std::span chunk = awake.subspan(begin).first(std::min(SurfaceQuery::kMostPrefetched, awake.size() - begin));
    if (single) find_lists(*target.solids.front().surface, set, chunk);
    for (const AwakePoint& point : chunk) measure_point(point);
  }
}

void ContactScene::Scan::measure_point(const AwakePoint& point) {
  const auto& [i, block, linear, p, near] = point;
  const double bound = near.list != nullptr && !near.surely ? near.list->lower_bound(p) : 0.0;
  double beyond = bound + pair.everywhere - margin;
  if (bound > near_enough) {
    set.anchor[i] = {p.cast<float>(), static_cast<float>(bound)};
  } else {
    const double allowed = allowance(set.own, i);
    const Touch touch = nearest(p, &set.hint[i * solids], &set.linear[i * solids], allowed, near);
    beyond = touch.distance + allowed - margin;
    // Interpolated distances may change faster than the point moves.
    if (exact && (touch.distance > 0 || touch.sample.triangle != geometry::kNoIndex))
      set.anchor[i] = {p.cast<float>(), static_cast<float>(touch.distance)};
    if (beyond < 0) list(p, touch, allowed);
  }
  set.point_wake[i] = beyond > 0 ? odometer + beyond : -1.0;
  double& wake = set.wake[block];
  if (beyond <= 0)
    wake = held_block;
  else if (wake != held_block)
    wake = std::min(wake, odometer + beyond);
}

/// Measures the samples added by add_point(), each time.
void ContactScene::Scan::measure_extra() {
  set.extra_hint.resize(set.extra.size() * solids, geometry::kNoIndex);
  for (std::size_t i = 0; i < set.extra.size(); ++i) {
    const Eigen::Vector3d p = rotation * set.extra[i] + shift;
    const double allowed = allowance(set.extra_own, i);
    const Touch touch = nearest(p, &set.extra_hint[i * solids], nullptr, allowed, {});
    if (touch.distance + allowed < margin) list(p, touch, allowed);
  }
}

ContactScene::Scan::Touch ContactScene::Scan::nearest(const Eigen::Vector3d& p, std::uint32_t* hint,
                                                      std::uint32_t* linear, double allowed, const Near& near) {
  const FlatnessWanted flatness{linear != nullptr ? 2 * margin : 0.0, scene.depths_.contact + allowed,
                                std::max(scene.depths_.contact, near.moved)};
  Touch best;
  best.distance = scene.reach_;
  for (std::size_t s = 0; s < solids; ++s) {
    const SolidField& solid = target.solids[s];
    // Outside, the box distance is a lower bound of the signed distance: it excludes most solids.
    if (best.distance <= 0 ? !solid.box.contains(p) : solid.box.squared_distance(p) >= best.distance * best.distance)
      continue;
    Sample sample;
    if (linear == nullptr || !recall(set, *solid.surface, linear[s], p, sample)) {
      sample = scene.signed_distance(solid, p, scene.reach_, flatness, hint[s], near);
      if (linear != nullptr && sample.flat_radius > 0) remember(set, linear[s], p, sample);
    }
    if (sample.value < best.distance) best = {sample.value, s, sample};
  }
  return best;
}

void ContactScene::Scan::list(const Eigen::Vector3d& p, const Touch& touch, double allowed) {
  ContactPoint c;
  c.gap = touch.distance + allowed;
  c.certain = std::max(std::abs(touch.distance), touch.sample.flat_radius);
  c.normal = to_world * touch.sample.normal;
  c.point = to_world * p + scene.world_[surface].t;
  c.owner = owner < scene.moving_ ? static_cast<int>(owner) : -1;
  c.surface = surface < scene.moving_ ? static_cast<int>(surface) : -1;
  c.owner_part = scene.members_[owner].part;
  c.surface_part = scene.members_[surface].part;
  const bool on_triangle = touch.sample.triangle != geometry::kNoIndex;
  if (on_triangle && touch.sample.flat_radius == 0) {
    c.plane_count =
        target.solids[touch.solid].surface->planes(p, touch.sample, scene.depths_.contact + allowed, c.planes);
    for (int i = 0; i < c.plane_count; ++i) {
      c.planes[i].normal = to_world * c.planes[i].normal;
      c.planes[i].gap += allowed;
    }
  }
  if (scene.surroundings_ && c.certain < margin && on_triangle && !(allowed > 0))
    list_surroundings(p, touch, c);
  else
    out.push_back(c);
}

/// Lists the contact, and those with the faces around it.
void ContactScene::Scan::list_surroundings(const Eigen::Vector3d& p, const Touch& touch, ContactPoint c) {
  FacePlane fronts[kMaxPlanes + 1], more[kMaxPlanes];
  int count = 0;
  fronts[0] = {touch.sample.normal, touch.distance};
  for (int i = 0; i < c.plane_count; ++i) fronts[1 + i] = {to_world.transpose() * c.planes[i].normal, c.planes[i].gap};
  c.certain = std::max(c.certain, target.solids[touch.solid].surface->surroundings(p, fronts, 1 + c.plane_count, margin,
                                                                                   scene.depths_.contact, more, count));
  out.push_back(c);
  c.plane_count = 0;
  for (int i = 0; i < count; ++i) {
    c.gap = more[i].gap;
    c.normal = to_world * more[i].normal;
    out.push_back(c);
  }
}

void ContactScene::scan(const ContactPair& pair, DirectedContacts& set, std::uint32_t owner, std::uint32_t surface,
                        double odometer, std::vector<ContactPoint>& out) {
  Scan pass(*this, pair, set, owner, surface, odometer, out);
  pass.prepare();
  pass.collect();
  pass.measure();
  pass.measure_extra();
}

}  // namespace dismantle::sdf
