#include "dismantle/geometry/winding.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "dismantle/geometry/numerics.h"

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;

/// Smallest turn of a segment, rad: below it, rounding displaces the axis too far.
constexpr double kLeastStep = 1e-3;

/// Velocity field v + w x x of the screw motion between two poses in unit time, by the shorter turn.
struct Field {
  Vec3 w = Vec3::Zero(), v = Vec3::Zero();
  Vec3 operator()(const Vec3& x) const { return v + w.cross(x); }
};

/// Axis, pitch and a point of the axis of the motion from `from` to `to`. False: the turn is too small or too large.
bool axis_of(const Pose& from, const Pose& to, Winding& winding, double& angle) {
  const Pose d = to * from.inverse();
  const Vec3 turn = rotation_vector(d.q);
  angle = turn.norm();
  if (angle < kLeastStep || angle > 1) return false;  // bounds of longer arcs are loose
  winding.axis = turn / angle;
  const double along = winding.axis.dot(d.t);
  const Vec3 across = d.t - along * winding.axis;
  winding.origin = 0.5 * (across + winding.axis.cross(across) / std::tan(0.5 * angle));
  winding.side = winding.axis.unitOrthogonal();
  winding.pitch = along / angle;
  return true;
}

Field field_of(const Winding& w, double angle) {
  Field f;
  f.w = angle * w.axis;
  f.v = angle * w.pitch * w.axis - f.w.cross(w.origin);
  return f;
}

/// `pose` after a turn by `angle` along the screw.
Pose screwed(const Winding& w, const Pose& pose, double angle) {
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, w.axis));
  return {q * (pose.t - w.origin) + w.origin + angle * w.pitch * w.axis, (q * pose.q).normalized()};
}

/// The longest winding that begins at instant k. Its first segment defines the screw; the others must agree.
bool winding_from(const RelativeMotion& motion, std::size_t k, double most_off, Winding& w) {
  double angle = 0;
  const Pose start = motion.at(static_cast<double>(k));
  if (!motion.is_screw(k) || !axis_of(start, motion.at(static_cast<double>(k + 1)), w, angle)) return false;
  w.begin = w.end = k;
  w.turned = {0};
  w.off = 0;
  double off_here = 0, extent = 0;
  for (std::size_t j = k; j < motion.segments() && motion.is_screw(j); ++j) {
    const Pose from = motion.at(static_cast<double>(j)), to = motion.at(static_cast<double>(j + 1));
    Winding own;
    double step = 0;
    if (!axis_of(from, to, own, step)) break;
    const double turned = step * own.axis.dot(w.axis);
    if (turned < 0.5 * step) break;
    // Both motions are screws. Between two instants their distance is at most that at the instants plus an eighth of
    // the difference of their accelerations (w x velocity).
    const Field is = field_of(own, step), wanted = field_of(w, turned);
    const Pose ideal = screwed(w, start, w.turned.back() + turned);
    double off_next = 0, speed = 0, apart = 0;
    for (const Vec3& c : motion.corners()) {
      off_next = std::max(off_next, (to * c - ideal * c).norm());
      extent = std::max(extent, (to * c).norm());
      const Vec3 x = from * c;
      speed = std::max(speed, is(x).norm());
      apart = std::max(apart, (is(x) - wanted(x)).norm());
    }
    const double axes = (is.w - wanted.w).norm();
    apart += axes * speed;
    const double off = (std::max(off_here, off_next) + (axes * speed + turned * apart) / 8) / (1 - turned * turned / 8);
    if (off > most_off) break;
    w.off = std::max(w.off, off);
    w.end = j + 1;
    w.turned.push_back(w.turned.back() + turned);
    off_here = off_next;
  }
  w.rounding = kRounding * extent;
  w.off += w.rounding;
  return w.end > k && w.turned.back() >= 1;  // unrolling does not speed up shorter ones
}

}  // namespace

std::vector<Winding> windings(const RelativeMotion& motion, double most_off) {
  std::vector<Winding> all;
  Winding w;
  for (std::size_t k = 0; k < motion.segments();) {
    if (winding_from(motion, k, most_off, w)) {
      all.push_back(w);
      k = w.end;
    } else {
      ++k;
    }
  }
  return all;
}

}  // namespace dismantle::geometry
