#include "dismantle/geometry/winding.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dismantle/geometry/numerics.h"

namespace dismantle::geometry {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

using std::numbers::pi;

/// Smallest turn of a segment, rad: below it, rounding displaces the axis too far.
constexpr double kLeastStep = 1e-3;
/// Triangles are divided until they are nearly straight within a cell, at most this often: into 1024.
constexpr int kDepth = 5;

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

std::array<Corners, 4> quarters(const Corners& t) {
  const Vec3 a = 0.5 * (t[0] + t[1]), b = 0.5 * (t[1] + t[2]), c = 0.5 * (t[2] + t[0]);
  return {Corners{t[0], a, c}, Corners{a, t[1], b}, Corners{c, b, t[2]}, Corners{a, b, c}};
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

namespace {

/// `off`: largest distance of the triangle from `t`.
Unrolled unroll(const Winding& w, const Corners& t, double off) {
  Unrolled u;
  const Vec3 across = w.axis.cross(w.side);
  // Mirror a left-hand screw to a right-hand one.
  const double up = w.pitch < 0 ? -1 : 1, pitch = std::abs(w.pitch);
  std::array<Vec2, 3> flat;
  std::array<double, 3> z;
  Vec2 center = Vec2::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 x = t[i] - w.origin;
    flat[i] = {x.dot(w.side), x.dot(across)};
    z[i] = up * x.dot(w.axis);
    center += flat[i] / 3;
  }
  double radius = 0, most_r = 0;
  for (const Vec2& x : flat) {
    radius = std::max(radius, (x - center).norm());
    most_r = std::max(most_r, x.norm());
  }
  const double least_r = center.norm() - radius;
  u.r_lo = std::max(0.0, least_r - off) - w.rounding;
  u.r_hi = most_r + off + w.rounding;
  const auto [z_least, z_most] = std::minmax({z[0], z[1], z[2]});
  u.z_lo = z_least - off - w.rounding;
  u.z_hi = z_most + off + w.rounding;
  u.bent = least_r < 0.5 * radius || least_r < 8 * off;
  if (u.bent) return u;
  // r and phi are nearly linear: at a weighted mean of the corners they differ from the mean of the corner values by at
  // most half the mean squared distance of the corners times the second derivative, 1 / r and 1 / r^2. As a norm, r is
  // convex and never exceeds the mean.
  const double sag = 0.5 * radius * radius / least_r, turn = sag / least_r + 2 * off / (least_r - off) + kRounding;
  const double about = std::atan2(center.y(), center.x());
  u.phi_lo = std::numeric_limits<double>::infinity();
  u.phi_hi = -u.phi_lo;
  for (std::size_t i = 0; i < 3; ++i) {
    const double cross = center.x() * flat[i].y() - center.y() * flat[i].x();
    const double phi = about + std::atan2(cross, center.dot(flat[i]));
    u.phi_lo = std::min(u.phi_lo, phi - turn);
    u.phi_hi = std::max(u.phi_hi, phi + turn);
    u.p[i] = {flat[i].norm(), z[i] - pitch * phi};
  }
  u.below = sag + off + w.rounding;
  u.above = off + w.rounding;
  u.beside = pitch * turn + off + w.rounding;
  return u;
}

}  // namespace

void Ring::add(const Winding& winding, const Corners& t) {
  const Unrolled u = unroll(winding, t, winding.off);
  r_lo = std::min(r_lo, u.r_lo);
  r_hi = std::max(r_hi, u.r_hi);
  z_lo = std::min(z_lo, u.z_lo);
  z_hi = std::max(z_hi, u.z_hi + std::abs(winding.pitch) * winding.turned.back() + winding.rounding);
}

UnrolledMesh::UnrolledMesh(const TriangleBvh& bvh, const Winding& winding, const Ring& asked, double cell)
    : winding_(winding),
      ring_(asked),
      lead_(2 * pi * std::abs(winding.pitch)),
      blind_(lead_ < 4 * cell),
      phi_lo_(std::numeric_limits<double>::infinity()),
      phi_hi_(-phi_lo_) {
  if (blind_ || !(ring_.r_hi > ring_.r_lo)) return;
  double least = ring_.r_hi, most = ring_.r_lo;
  std::vector<std::uint32_t> there;
  for (const std::uint32_t t : bvh.order()) {
    const Unrolled u = unroll(winding_, bvh.corners(t), 0);
    if (!near(u)) continue;
    there.push_back(t);
    least = std::min(least, u.r_lo);
    most = std::max(most, u.r_hi);
    extend(bvh.corners(t), kDepth);
  }
  if (there.empty()) return;
  ring_.r_lo = std::max(ring_.r_lo, least);
  ring_.r_hi = std::min(ring_.r_hi, most);
  for (cell_ = cell;; cell_ *= 1.25) {
    rows_ = static_cast<long>(std::ceil((ring_.r_hi - ring_.r_lo) / cell_)) + 1;
    columns_ = static_cast<long>(std::ceil(lead_ / cell_));
    if (rows_ * columns_ <= 1'500'000) break;  // bounds the work
  }
  taken_ = RowRuns(static_cast<std::size_t>(rows_));
  empty_ = false;
  by_bent_.assign(static_cast<std::size_t>(rows_), Bits{});
  in_row_ = by_bent_;
  for (const std::uint32_t t : there) enter(bvh.corners(t), kDepth);
  taken_.finish();
}

/// Extends the range of phi of the mesh by that of a triangle.
void UnrolledMesh::extend(const Corners& t, int depth) {
  const Unrolled u = unroll(winding_, t, 0);
  if (!near(u)) return;
  if (u.bent) {
    for (const Corners& q : quarters(t))
      if (depth > 0) extend(q, depth - 1);
    return;
  }
  for (const Vec2& p : u.p)
    for (const double beside : {-u.beside - cell_, u.beside + cell_}) {
      const double turns = 2 * pi * std::floor((p.y() + beside) / lead_);
      phi_lo_ = std::min(phi_lo_, u.phi_lo + turns);
      phi_hi_ = std::max(phi_hi_, u.phi_hi + turns);
    }
}

/// The pieces of the range of phi that [lo, hi] overlaps; values beyond the range belong to its end pieces.
UnrolledMesh::Bits UnrolledMesh::bits(double lo, double hi) const {
  const auto pieces = static_cast<double>(8 * sizeof(Bits));
  const double piece = std::max(kRounding, phi_hi_ - phi_lo_) / pieces;
  const auto index = [&](double phi) {
    return static_cast<int>(std::clamp(std::floor((phi - phi_lo_) / piece), 0.0, pieces - 1));
  };
  Bits b{};
  for (int i = index(lo), last = index(hi); i <= last; ++i) b[static_cast<std::size_t>(i / 64)] |= 1ULL << (i % 64);
  return b;
}

/// For triangles at any angle: with psi reduced to [0, lead), phi determines the height.
UnrolledMesh::Bits UnrolledMesh::bits_of_bent(const Unrolled& u, double from, double to) const {
  const double pitch = lead_ / (2 * pi);
  return bits(u.z_lo / pitch - 2 * pi + from - kLeastStep, u.z_hi / pitch + to + kLeastStep);
}

std::pair<long, long> UnrolledMesh::rows_of(double lo, double hi) const {
  return {std::max(0L, static_cast<long>(std::floor((lo - ring_.r_lo) / cell_))),
          std::min(rows_ - 1, static_cast<long>(std::floor((hi - ring_.r_lo) / cell_)))};
}

/// Calls f(row, first, last, turns) for all runs of cells that the triangle may overlap; `turns` is the number of full
/// turns by which it is wound back. Returns false as soon as f does. Skips rows with false in_row(row).
template <class Row, class Run>
bool UnrolledMesh::runs_of(const Unrolled& u, const Row& in_row, const Run& f) const {
  const auto [first, last] = std::minmax({u.p[0].x(), u.p[1].x(), u.p[2].x()});
  const auto [row0, row1] = rows_of(first - u.below, last + u.above);
  const double column = lead_ / static_cast<double>(columns_);
  for (long row = row0; row <= row1; ++row) {
    if (!in_row(row)) continue;
    // Range of psi of the points with r in [r0, r1], without slack.
    const double r0 = ring_.r_lo + static_cast<double>(row) * cell_ - u.above - winding_.rounding;
    const double r1 = ring_.r_lo + static_cast<double>(row + 1) * cell_ + u.below + winding_.rounding;
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2 &a = u.p[i], &b = u.p[(i + 1) % 3];
      if (a.x() >= r0 && a.x() <= r1) lo = std::min(lo, a.y()), hi = std::max(hi, a.y());
      for (const double r : {r0, r1})
        if ((a.x() < r) != (b.x() < r)) {
          const double share = (r - a.x()) / (b.x() - a.x()), psi = a.y() + share * (b.y() - a.y());
          lo = std::min(lo, psi);
          hi = std::max(hi, psi);
        }
    }
    if (lo > hi) continue;
    const long c0 = static_cast<long>(std::floor((lo - u.beside - winding_.rounding) / column));
    const long c1 = static_cast<long>(std::floor((hi + u.beside + winding_.rounding) / column));
    for (long c = c0; c <= c1;) {
      const long turns = c >= 0 ? c / columns_ : -((-c + columns_ - 1) / columns_);
      const long end = std::min(c1, (turns + 1) * columns_ - 1);
      const auto in_turn = [&](long at) { return static_cast<std::int32_t>(at - turns * columns_); };
      if (!f(static_cast<std::size_t>(row), in_turn(c), in_turn(end), turns)) return false;
      c = end + 1;
    }
  }
  return true;
}

void UnrolledMesh::enter(const Corners& t, int depth) {
  const Unrolled u = unroll(winding_, t, 0);
  if (!near(u)) return;
  if (depth > 0 && (u.bent || u.below > cell_)) {
    for (const Corners& q : quarters(t)) enter(q, depth - 1);
    return;
  }
  const auto add = [](Bits& to, const Bits& b) { to[0] |= b[0], to[1] |= b[1]; };
  if (u.bent) {
    const Bits b = bits_of_bent(u, 0, 0);
    const auto [row0, row1] = rows_of(u.r_lo, u.r_hi);
    for (long row = row0; row <= row1; ++row) {
      add(in_row_[static_cast<std::size_t>(row)], b);
      add(by_bent_[static_cast<std::size_t>(row)], b);
    }
    return;
  }
  long known = std::numeric_limits<long>::max();
  Bits b{};
  runs_of(
      u, [](long) { return true; },
      [&](std::size_t row, std::int32_t first, std::int32_t last, long turns) {
        if (turns != known) {
          known = turns;
          const double by = 2 * pi * static_cast<double>(turns);
          b = bits(u.phi_lo + by, u.phi_hi + by);
        }
        taken_.add(row, first, last, b);
        add(in_row_[row], b);
        return true;
      });
}

bool UnrolledMesh::free(const Corners& t, double from, double to, int depth, std::uint64_t& cells) const {
  const Unrolled u = unroll(winding_, t, winding_.off);
  ++cells;
  if (!near(u)) return true;
  const auto none = [](const Bits& x, const Bits& y) { return (x[0] & y[0]) == 0 && (x[1] & y[1]) == 0; };
  // For any psi: is the mesh at these radii and heights at all?
  const Bits any = bits_of_bent(u, from, to);
  const auto [row0, row1] = rows_of(u.r_lo, u.r_hi);
  bool alone = true;
  for (long row = row0; row <= row1 && alone; ++row) alone = none(in_row_[static_cast<std::size_t>(row)], any);
  cells += static_cast<std::uint64_t>(std::max(0L, row1 - row0)) / 4;
  if (alone) return true;
  if (depth > 0 && (u.bent || u.below > cell_)) {
    for (const Corners& q : quarters(t))
      if (!free(q, from, to, depth - 1, cells)) return false;
    return true;
  }
  if (u.bent) return false;
  long known = std::numeric_limits<long>::max();
  Bits b{};
  return runs_of(
      u, [&](long row) { return !none(in_row_[static_cast<std::size_t>(row)], any); },
      [&](std::size_t row, std::int32_t first, std::int32_t last, long turns) {
        ++cells;
        if (turns != known) {
          known = turns;
          const double by = 2 * pi * static_cast<double>(turns);
          b = bits(u.phi_lo + by + from, u.phi_hi + by + to);
        }
        return none(by_bent_[row], b) && taken_.each(row, first, last, [&](const Bits& taken) {
          ++cells;
          return none(taken, b);
        });
      });
}

bool UnrolledMesh::clear_of(const Corners& moved, std::size_t from, std::size_t to, std::uint64_t& cells) const {
  if (blind_) return false;
  if (empty_) return true;
  return free(moved, winding_.turned_at(from), winding_.turned_at(to), kDepth, cells);
}

}  // namespace dismantle::geometry
