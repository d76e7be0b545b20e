#include "dismantle/sdf/contact_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

Aabb world_box(const Aabb& local, const Pose& pose) {
  const Eigen::Vector3d center = pose * local.center();
  const Eigen::Vector3d half = pose.q.toRotationMatrix().cwiseAbs() * (0.5 * local.size());
  return {center - half, center + half};
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

double box_gap(const Aabb& a, const Aabb& b) { return (a.lo - b.hi).cwiseMax(b.lo - a.hi).cwiseMax(0.0).norm(); }

}  // namespace

void ContactScene::set_members(std::vector<Member> moving, std::vector<Member> fixed) {
  moving_ = moving.size();
  members_ = std::move(moving);
  members_.insert(members_.end(), fixed.begin(), fixed.end());
  odometer_.assign(moving_, 0.0);
  world_.resize(members_.size());
  boxes_.resize(members_.size());
  for (std::size_t i = 0; i < members_.size(); ++i) {
    world_[i] = members_[i].pose * members_[i].placed->rest;
    boxes_[i] = world_box(members_[i].placed->shape->box, world_[i]);
  }
  for (std::uint32_t a = 0; a < moving_; ++a)
    for (std::uint32_t b = a + 1; b < members_.size(); ++b) {
      pairs_.emplace_back();
      pairs_.back().a = a;
      pairs_.back().b = b;
    }
}

void ContactScene::add_point(PartId part, PartId other, const Eigen::Vector3d& point) {
  rest_ = nullptr;
  const auto add = [&](const ContactPair& pair, DirectedContacts& set, const Member& owner, const Member& surface) {
    set.extra.push_back(owner.placed->rest.inverse() * point);
    set.extra_own.push_back(assembled_depth(pair, owner, surface, set.extra.back()));
  };
  for (auto& pair : pairs_) {
    const Member &a = members_[pair.a], &b = members_[pair.b];
    if (a.part == part && b.part == other) add(pair, pair.ab, a, b);
    if (b.part == part && a.part == other) add(pair, pair.ba, b, a);
  }
}

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

void ContactScene::scan(ContactPair& pair, DirectedContacts& set, std::uint32_t owner, std::uint32_t surface,
                        double margin, double odometer, std::vector<ContactPoint>& out) {
  const Shape& points = *members_[owner].placed->shape;
  const Shape& target = *members_[surface].placed->shape;
  const std::size_t solids = target.solids.size();
  if (!set.ready) {
    set.wake.assign(points.points.blocks.size(), -1.0);
    set.point_wake.assign(points.points.points.size(), -1.0);
    set.anchor.assign(points.points.points.size(), {});
    set.hint.assign(points.points.points.size() * solids, geometry::kNoIndex);
    set.linear.assign(points.points.points.size() * solids, 0);
    if (pair.everywhere < pair.allowed) measure_own_depths(pair, set, members_[owner], members_[surface]);
    set.ready = true;
  }
  const bool local = pair.everywhere < pair.allowed, single = model_ == DistanceModel::exact && solids == 1;
  // A bound above this replaces the distance; below it, distances were measured on triangles.
  const double near_enough = kFarEnough * margin;
  const Pose to_target = world_[surface].inverse() * world_[owner];
  const Eigen::Matrix3d rotation = to_target.q.toRotationMatrix();
  const Eigen::Vector3d shift = to_target.t;
  const Eigen::Matrix3d to_world = world_[surface].q.toRotationMatrix();

  struct Touch {
    double distance = 0;
    std::size_t solid = 0;
    Sample sample;
  };
  const auto emit = [&](const Eigen::Vector3d& p, const Touch& touch, double allowed) {
    ContactPoint c;
    c.gap = touch.distance + allowed;
    c.certain = std::max(std::abs(touch.distance), touch.sample.flat_radius);
    c.normal = to_world * touch.sample.normal;
    c.point = to_world * p + world_[surface].t;
    c.owner = owner < moving_ ? static_cast<int>(owner) : -1;
    c.surface = surface < moving_ ? static_cast<int>(surface) : -1;
    c.owner_part = members_[owner].part;
    c.surface_part = members_[surface].part;
    if (touch.sample.triangle != geometry::kNoIndex && touch.sample.flat_radius == 0) {
      c.plane_count = target.solids[touch.solid].surface->planes(p, touch.sample, depths_.contact + allowed, c.planes);
      for (int i = 0; i < c.plane_count; ++i) {
        c.planes[i].normal = to_world * c.planes[i].normal;
        c.planes[i].gap += allowed;
      }
    }
    if (!surroundings_ || c.certain >= margin || touch.sample.triangle == geometry::kNoIndex || allowed > 0) {
      out.push_back(c);
      return;
    }
    FacePlane fronts[kMaxPlanes + 1], more[kMaxPlanes];
    int count = 0;
    fronts[0] = {touch.sample.normal, touch.distance};
    for (int i = 0; i < c.plane_count; ++i)
      fronts[1 + i] = {to_world.transpose() * c.planes[i].normal, c.planes[i].gap};
    c.certain = std::max(c.certain, target.solids[touch.solid].surface->surroundings(
                                        p, fronts, 1 + c.plane_count, margin, depths_.contact, more, count));
    out.push_back(c);
    c.plane_count = 0;
    for (int i = 0; i < count; ++i) {
      c.gap = more[i].gap;
      c.normal = to_world * more[i].normal;
      out.push_back(c);
    }
  };
  const auto nearest = [&](const Eigen::Vector3d& p, std::uint32_t* hint, std::uint32_t* linear, double allowed,
                           const Near& near) {
    const FlatnessWanted flatness{linear != nullptr ? 2 * margin : 0.0, depths_.contact + allowed,
                                  std::max(depths_.contact, near.way)};
    Touch best;
    best.distance = reach_;
    for (std::size_t s = 0; s < solids; ++s) {
      // Outside, the box distance is a lower bound of the signed distance: it excludes most solids.
      const Aabb& box = target.solids[s].box;
      if (best.distance <= 0 ? !box.contains(p) : box.squared_distance(p) >= best.distance * best.distance) continue;
      Sample sample;
      if (linear == nullptr || !recall(set, *target.solids[s].surface, linear[s], p, sample)) {
        sample = signed_distance(target.solids[s], p, reach_, flatness, hint[s], near);
        if (linear != nullptr && sample.flat_radius > 0) remember(set, linear[s], p, sample);
      }
      if (sample.value < best.distance) best = {sample.value, s, sample};
    }
    return best;
  };

  // Collect the points that may be near, then measure their distances together, so that memory accesses overlap.
  awake_.clear();
  for (std::uint32_t k = 0; k < points.points.blocks.size(); ++k) {
    if (set.wake[k] > odometer) continue;
    const PointBlock& block = points.points.blocks[k];
    const Eigen::Vector3d center = rotation * block.center + shift;
    // If a point was listed, a bound for the whole block is of no use yet.
    const bool held = set.wake[k] == held_block;
    double lower = held ? 0.0 : std::sqrt(target.box.squared_distance(center)) - block.radius;
    if (!held && lower + pair.everywhere < margin) {
      double free = 4 * reach_;
      for (const SolidField& s : target.solids) {
        const double outside = std::sqrt(s.box.squared_distance(center));
        free = std::min(free, std::max(outside, s.grid->lower_bound(center)));
      }
      lower = std::max(lower, free - block.radius);
    }
    // With a bound of zero the block may be inside, at any depth.
    double slack = lower > 0 ? lower + pair.everywhere - margin : -1.0;
    if (slack > 0) {
      set.wake[k] = odometer + slack;
      continue;
    }
    slack = reach_;
    for (std::uint32_t i = block.first; i < block.first + block.count; ++i) {
      if (set.point_wake[i] > odometer) {
        slack = std::min(slack, set.point_wake[i] - odometer);
        continue;
      }
      AwakePoint point{i, k, false, rotation * points.points.points[i] + shift, {}};
      // The odometer bounds the motion of all points; this point may have moved less and still be far enough away.
      if (const Anchor& anchor = set.anchor[i]; anchor.is_known()) {
        const double way = (point.at - anchor.point.cast<double>()).norm() + rounding_of(anchor);
        const double beyond = anchor.distance - way + pair.everywhere - margin;
        if (beyond > 0) {
          set.point_wake[i] = odometer + beyond;
          slack = std::min(slack, beyond);
          continue;
        }
        point.near.surely = single && std::abs(anchor.distance) + way < near_enough;
        // If a point keeps moving as far as before, it leaves any smaller radius. Surroundings need all radii.
        if (!surroundings_) point.near.way = way;
      }
      point.linear = is_linear_at(set, set.linear[i * solids], point.at);
      awake_.push_back(point);
    }
    set.wake[k] = odometer + slack;  // for awake points: set below
  }
  for (std::size_t begin = 0; begin < awake_.size(); begin += SurfaceQuery::kMostPrefetched) {
    const std::span chunk =
        std::span(awake_).subspan(begin).first(std::min(SurfaceQuery::kMostPrefetched, awake_.size() - begin));
    if (single) find_lists(*target.solids.front().surface, set, chunk);
    for (const auto& [i, block, linear, p, near] : chunk) {
      const double bound = near.list != nullptr && !near.surely ? near.list->lower_bound(p) : 0.0;
      double beyond = bound + pair.everywhere - margin;
      if (bound > near_enough) {
        set.anchor[i] = {p.cast<float>(), static_cast<float>(bound)};
      } else {
        const double allowed = local ? std::max<double>(pair.everywhere, set.own[i]) : pair.everywhere;
        const Touch touch = nearest(p, &set.hint[i * solids], &set.linear[i * solids], allowed, near);
        beyond = touch.distance + allowed - margin;
        // Interpolated distances may change faster than the point moves.
        if (model_ == DistanceModel::exact && (touch.distance > 0 || touch.sample.triangle != geometry::kNoIndex))
          set.anchor[i] = {p.cast<float>(), static_cast<float>(touch.distance)};
        if (beyond < 0) emit(p, touch, allowed);
      }
      set.point_wake[i] = beyond > 0 ? odometer + beyond : -1.0;
      double& wake = set.wake[block];
      if (beyond <= 0)
        wake = held_block;
      else if (wake != held_block)
        wake = std::min(wake, odometer + beyond);
    }
  }
  set.extra_hint.resize(set.extra.size() * solids, geometry::kNoIndex);
  for (std::size_t i = 0; i < set.extra.size(); ++i) {
    const Eigen::Vector3d p = rotation * set.extra[i] + shift;
    const double allowed = local ? std::max<double>(pair.everywhere, set.extra_own[i]) : pair.everywhere;
    const Touch touch = nearest(p, &set.extra_hint[i * solids], nullptr, allowed, {});
    if (touch.distance + allowed < margin) emit(p, touch, allowed);
  }
}

void ContactScene::update_pair(ContactPair& pair, std::vector<ContactPoint>& out) {
  const double odometer = odometer_[pair.a] + (pair.b < moving_ ? odometer_[pair.b] : 0.0);
  if (pair.wake > odometer) return;
  const double gap = box_gap(boxes_[pair.a], boxes_[pair.b]), slack = gap + pair.everywhere - margin_;
  if (gap > 0 && slack > 0) {  // overlapping boxes give no bound
    pair.wake = odometer + slack;
    return;
  }
  pair.wake = 0;
  scan(pair, pair.ab, pair.a, pair.b, margin_, odometer, out);
  scan(pair, pair.ba, pair.b, pair.a, margin_, odometer, out);
}

/// The first update with every part in assembled position: copies the pairs measured by another scene.
void ContactScene::begin_at_rest(std::vector<ContactPoint>& out) {
  for (auto& pair : pairs_) {
    const Member &a = members_[pair.a], &b = members_[pair.b];
    const auto& known = rest_->of(a.part, b.part, [&](RestContacts::Entry& entry) {
      ContactScene alone(
          {a}, {b}, model_, margin_, [&](PartId, PartId) { return pair.allowed - depths_.threshold; }, depths_);
      alone.surroundings_ = surroundings_;
      alone.update({a.pose}, entry.points);
      entry.pair = std::move(alone.pairs_.front());
    });
    const std::uint32_t ia = pair.a, ib = pair.b;
    pair = known.pair;
    pair.a = ia;
    pair.b = ib;
    const int moving_b = ib < moving_ ? static_cast<int>(ib) : -1;
    for (const ContactPoint& c : known.points) {
      out.push_back(c);
      out.back().owner = c.owner == 0 ? static_cast<int>(ia) : moving_b;
      out.back().surface = c.surface == 0 ? static_cast<int>(ia) : moving_b;
    }
  }
}

void ContactScene::update(const std::vector<Pose>& poses, std::vector<ContactPoint>& out) {
  out.clear();
  if (rest_ != nullptr) {
    bool assembled = true;
    for (std::size_t i = 0; i < members_.size() && assembled; ++i) {
      const Pose& p = i < moving_ ? poses[i] : members_[i].pose;
      assembled = p.t == Eigen::Vector3d::Zero() && p.q.coeffs() == Eigen::Quaterniond::Identity().coeffs();
    }
    if (assembled) begin_at_rest(out);
    rest_ = nullptr;
    if (assembled) return;
  }
  for (std::size_t i = 0; i < moving_; ++i) {
    const Pose next = poses[i] * members_[i].placed->rest;
    const Eigen::Vector3d c = members_[i].placed->shape->mass.center;
    const double turn = angle_between(world_[i].q, next.q);
    odometer_[i] += (next * c - world_[i] * c).norm() + turn * radius(i);
    world_[i] = next;
    boxes_[i] = world_box(members_[i].placed->shape->box, next);
  }
  for (auto& pair : pairs_) update_pair(pair, out);
}

ContactScene ContactScene::with_margin(double margin) const {
  ContactScene other = *this;
  other.margin_ = margin;
  other.rest_ = nullptr;
  for (ContactPair& pair : other.pairs_) {
    pair.wake = 0;
    for (DirectedContacts* set : {&pair.ab, &pair.ba}) {
      DirectedContacts fresh;
      fresh.extra = std::move(set->extra);
      fresh.extra_own = std::move(set->extra_own);
      *set = std::move(fresh);
    }
  }
  return other;
}

}  // namespace dismantle::sdf
