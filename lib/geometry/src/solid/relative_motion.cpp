#include "dismantle/geometry/relative_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;

/// Velocity field of a screw motion, constant in time and in world axes: v(x) = v + w x (x - origin).
struct Field {
  Vec3 w = Vec3::Zero(), v = Vec3::Zero(), origin = Vec3::Zero();
  Vec3 operator()(const Vec3& x) const { return v + w.cross(x - origin); }
};

Field field_of(const Pose& from, const Pose& to) {
  Field f;
  f.w = rotation_vector(to.q * from.q.conjugate());
  f.origin = from.t;
  const double angle2 = f.w.squaredNorm();
  const Vec3 d = to.t - from.t;
  // Inverse of the left Jacobian, see geometry/pose.cpp; a copy, because the verifier shares little code.
  double c = 1.0 / 12;
  if (angle2 > 1e-6) {
    const double angle = std::sqrt(angle2);
    c = (1 - 0.5 * angle * std::cos(0.5 * angle) / std::sin(0.5 * angle)) / angle2;
  }
  f.v = d - 0.5 * f.w.cross(d) + c * f.w.cross(f.w.cross(d));
  return f;
}

const Pose& pose_at(const std::vector<Pose>& poses, std::size_t k) { return poses.size() == 1 ? poses[0] : poses[k]; }

}  // namespace

RelativeMotion::RelativeMotion(std::vector<Pose> a, std::vector<Pose> b, const Aabb& box)
    : a_(std::move(a)), b_(std::move(b)) {
  for (std::size_t k = 0; k < 8; ++k)
    corners_[k] = {k & 1 ? box.hi.x() : box.lo.x(), k & 2 ? box.hi.y() : box.lo.y(), k & 4 ? box.hi.z() : box.lo.z()};
  const std::size_t instants = std::max(a_.size(), b_.size());
  at_instant_.reserve(instants);
  for (std::size_t k = 0; k < instants; ++k) at_instant_.emplace_back(pose_at(b_, k).inverse() * pose_at(a_, k));
  bend_.assign(instants - 1, 0);
  screws_.resize(instants - 1);
  for (std::size_t k = 0; k + 1 < instants; ++k) {
    const Pose& start = pose_at(a_, k);
    const Field fa = field_of(start, pose_at(a_, k + 1)), fb = field_of(pose_at(b_, k), pose_at(b_, k + 1));
    const bool a_still = fa.w.isZero(0) && fa.v.isZero(0), b_still = fb.w.isZero(0) && fb.v.isZero(0);
    if (a_still || b_still) {
      const Field& f = b_still ? fa : fb;
      screws_[k] = {true, f.w, f.v, f.origin, Placement(start)};
    }
    const double turn = (fa.w - fb.w).norm();
    for (const auto& c : corners_) {
      // In B's frame y'' = (wa - wb) x va - wb x (va - vb), in world axes, at the position of the point.
      const Vec3 x = start * c, va = fa(x), vb = fb(x);
      double bound;
      if (b_still)
        bound = fa.w.cross(va).norm();  // constant along the motion
      else if (a_still)
        bound = fb.w.cross(vb).norm();
      else
        bound = turn * va.norm() + fb.w.norm() * ((va - vb).norm() + turn * va.norm());
      bend_[k] = std::max(bend_[k], bound);
    }
    bend_[k] *= 1 + 1e-9;
  }
}

Pose RelativeMotion::at(double s) const {
  const double last = static_cast<double>(segments());
  s = std::clamp(s, 0.0, last);
  const auto k = static_cast<std::size_t>(std::min(std::floor(s), std::max(0.0, last - 1)));
  const double u = s - static_cast<double>(k);
  const auto part = [&](const std::vector<Pose>& poses) {
    return poses.size() == 1 ? poses[0] : screw_interpolate(poses[k], poses[k + 1], u);
  };
  return part(b_).inverse() * part(a_);
}

bool RelativeMotion::constant(double tolerance) const {
  for (std::size_t k = 0; k < at_instant_.size(); ++k) {
    if (k < bend_.size() && bend_[k] / 8 > tolerance) return false;
    for (const auto& c : corners_)
      if ((at_instant_[k] * c - at_instant_[0] * c).norm() > tolerance) return false;
  }
  return true;
}

double RelativeMotion::chord_deviation(std::size_t i, std::size_t j) const {
  const Placement &from = at_instant_[i], &to = at_instant_[j];
  Vec3 middle = Vec3::Zero();
  for (const auto& c : corners_) middle += c / 8;
  const Vec3 start = from * middle, displacement = to * middle - start;
  const double displacement2 = displacement.squaredNorm();
  double worst = 0;
  for (std::size_t k = i; k < j; ++k) worst = std::max(worst, bend_[k] / 8);
  double off = 0;
  for (std::size_t k = i + 1; k < j; ++k) {
    const double w = displacement2 > 1e-20
                         ? std::clamp((at_instant_[k] * middle - start).dot(displacement) / displacement2, 0.0, 1.0)
                         : static_cast<double>(k - i) / static_cast<double>(j - i);
    // The offset is affine in the point, so its maximum is at a corner of the box.
    for (const auto& c : corners_)
      off = std::max(off, (at_instant_[k] * c - (1 - w) * (from * c) - w * (to * c)).norm());
  }
  return worst + off;
}

double RelativeMotion::deviation(double s0, double s1) const {
  const auto i = static_cast<std::size_t>(std::floor(s0));
  if (s1 - s0 > 1 || (s1 - s0 == 1 && s0 == std::floor(s0))) return chord_deviation(i, static_cast<std::size_t>(s1));
  const std::size_t k = std::min(i, bend_.empty() ? 0 : bend_.size() - 1);
  return bend_.empty() ? 0 : bend_[k] * (s1 - s0) * (s1 - s0) / 8;
}

RelativeMotion::Bend RelativeMotion::bend(double s0, double s1) const {
  Bend bend;
  bend.whole_ = deviation(s0, s1);
  const auto i = static_cast<std::size_t>(std::floor(s0));
  if (s1 <= static_cast<double>(i + 1)) {
    if (i >= screws_.size() || !screws_[i].known) return bend;
    bend.screw_ = &screws_[i];
    bend.share2_ = (s1 - s0) * (s1 - s0);
    return bend;
  }
  const auto j = static_cast<std::size_t>(s1);
  if (j - i > 24) return bend;  // for long chords a bound per point is no tighter than that of the box
  const Placement &from = at_instant_[i], &to = at_instant_[j];
  Vec3 middle = Vec3::Zero();
  for (const auto& c : corners_) middle += c / 8;
  const Vec3 start = from * middle, displacement = to * middle - start;
  const double displacement2 = displacement.squaredNorm();
  for (std::size_t k = i; k < j; ++k) bend.along_ = std::max(bend.along_, bend_[k] / 8);
  for (std::size_t k = i + 1; k < j; ++k) {
    const double w = displacement2 > 1e-20
                         ? std::clamp((at_instant_[k] * middle - start).dot(displacement) / displacement2, 0.0, 1.0)
                         : static_cast<double>(k - i) / static_cast<double>(j - i);
    Bend::Offset o;
    o.m = at_instant_[k].r - (1 - w) * from.r - w * to.r;
    o.t = at_instant_[k].t - (1 - w) * from.t - w * to.t;
    o.stretch = o.m.norm();
    bend.offsets_.push_back(o);
  }
  return bend;
}

double RelativeMotion::Bend::at(const Vec3& center, double radius) const {
  if (screw_ != nullptr) {
    // Along a screw motion the acceleration of a point has constant magnitude.
    const Screw& f = *screw_;
    const Vec3 x = f.start * center;
    const double bound = f.w.cross(f.v + f.w.cross(x - f.origin)).norm() + f.w.squaredNorm() * radius;
    return std::min(whole_, bound * (1 + 1e-9) * share2_ / 8);
  }
  if (offsets_.empty()) return whole_;
  double off = 0;
  for (const Offset& o : offsets_) off = std::max(off, (o.m * center + o.t).norm() + o.stretch * radius);
  return std::min(whole_, along_ + off * (1 + 1e-9));
}

Aabb RelativeMotion::swept_box() const {
  Aabb box;
  for (const auto& m : at_instant_)
    for (const auto& c : corners_) box.extend(m * c);
  double bend = 0;
  for (const double b : bend_) bend = std::max(bend, b / 8);
  box.inflate(bend);
  return box;
}

std::vector<Aabb> RelativeMotion::segment_boxes() const {
  std::vector<Aabb> at(at_instant_.size()), boxes(segments());
  for (std::size_t k = 0; k < at.size(); ++k)
    for (const auto& c : corners_) at[k].extend(at_instant_[k] * c);
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    boxes[k] = at[k];
    boxes[k].extend(at[k + 1]);
    boxes[k].inflate(bend_[k] / 8);
  }
  return boxes;
}

}  // namespace dismantle::geometry
