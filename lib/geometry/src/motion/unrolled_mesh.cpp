#include "dismantle/geometry/unrolled_mesh.h"

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

/// Slack of a range of angles, rad: far beyond rounding, and far below a turn.
constexpr double kAngleSlack = 1e-3;
/// Triangles are divided until they are nearly straight within a cell, at most this often: into 1024.
constexpr int kDepth = 5;
/// Rows of the mesh for each row of what is asked.
constexpr long kWide = 4;

std::array<Corners, 4> quarters(const Corners& t) {
  const Vec3 a = 0.5 * (t[0] + t[1]), b = 0.5 * (t[1] + t[2]), c = 0.5 * (t[2] + t[0]);
  return {Corners{t[0], a, c}, Corners{a, t[1], b}, Corners{c, b, t[2]}, Corners{a, b, c}};
}

using Bits = RowRuns::Bits;

using Turns = UnrolledRaster::Turns;

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

void Ring::add(const Winding& winding, const Corners& t, std::size_t from, std::size_t to) {
  const Unrolled u = unroll(winding, t, winding.off);
  r_lo = std::min(r_lo, u.r_lo);
  r_hi = std::max(r_hi, u.r_hi);
  const double pitch = std::abs(winding.pitch);  // up is the direction of the advance
  z_lo = std::min(z_lo, u.z_lo + pitch * winding.turned_at(from) - winding.rounding);
  z_hi = std::max(z_hi, u.z_hi + pitch * winding.turned_at(to) + winding.rounding);
}

UnrolledRaster::UnrolledRaster(const Ring& ring, double lead_of_screw, double rounding_of_screw, double width)
    : r_lo(ring.r_lo), cell(width), lead(lead_of_screw), rounding(rounding_of_screw) {
  rows = static_cast<long>(std::ceil((ring.r_hi - ring.r_lo) / cell)) + 1;
  columns = static_cast<long>(std::ceil(lead / cell));
}

std::pair<long, long> UnrolledRaster::rows_of(double lo, double hi) const {
  return {std::max(0L, static_cast<long>(std::floor((lo - r_lo) / cell))),
          std::min(rows - 1, static_cast<long>(std::floor((hi - r_lo) / cell)))};
}

template <class Row, class Run>
bool UnrolledRaster::runs_of(const Unrolled& u, const Row& in_row, const Run& f) const {
  const auto [first, last] = std::minmax({u.p[0].x(), u.p[1].x(), u.p[2].x()});
  const auto [row0, row1] = rows_of(first - u.below, last + u.above);
  const double column = lead / static_cast<double>(columns);
  for (long row = row0; row <= row1; ++row) {
    if (!in_row(row)) continue;
    // Range of psi of the points with r in [r0, r1], without slack.
    const double r0 = r_lo + static_cast<double>(row) * cell - u.above - rounding;
    const double r1 = r_lo + static_cast<double>(row + 1) * cell + u.below + rounding;
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
    const long c0 = static_cast<long>(std::floor((lo - u.beside - rounding) / column));
    const long c1 = static_cast<long>(std::floor((hi + u.beside + rounding) / column));
    const auto turns = [&](long c) { return c >= 0 ? c / columns : -((-c + columns - 1) / columns); };
    const auto run = [&](long from, long to, Turns by) {
      const auto in_turn = [&](long c) { return static_cast<std::int32_t>(c - turns(c) * columns); };
      return f(static_cast<std::size_t>(row), in_turn(from), in_turn(to), by);
    };
    const long t0 = turns(c0), t1 = turns(c1), end = (t0 + 1) * columns - 1;
    if (!run(c0, std::min(c1, end), {t0, t0})) return false;
    // All columns, once for all turns between.
    if (t1 > t0 + 1 && !run(end + 1, end + columns, {t0 + 1, t1 - 1})) return false;
    if (t1 > t0 && !run(t1 * columns, c1, {t1, t1})) return false;
  }
  return true;
}

UnrolledMesh::UnrolledMesh(const TriangleBvh& bvh, const Winding& winding, std::span<const Corners> asked,
                           std::size_t from, std::size_t to, double cell)
    : winding_(winding),
      lead_(2 * pi * std::abs(winding.pitch)),
      blind_(lead_ < 4 * cell),
      phi_lo_(std::numeric_limits<double>::infinity()),
      phi_hi_(-phi_lo_) {
  for (const Corners& t : asked) ring_.add(winding, t, from, to);
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
  for (;; cell *= 1.25) {
    fine_ = UnrolledRaster(ring_, lead_, winding_.rounding, cell);
    if (fine_.rows * fine_.columns <= 1'500'000) break;  // bounds the work
  }
  wide_ = UnrolledRaster(ring_, lead_, winding_.rounding, static_cast<double>(kWide) * fine_.cell);
  asked_ = RowRuns(static_cast<std::size_t>(wide_.rows));
  for (const Corners& t : asked) ask(t, winding_.turned_at(from), winding_.turned_at(to), kDepth);
  asked_.finish();
  taken_ = RowRuns(static_cast<std::size_t>(fine_.rows));
  empty_ = false;
  by_bent_.assign(static_cast<std::size_t>(fine_.rows), Bits{});
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
    for (const double beside : {-u.beside - fine_.cell, u.beside + fine_.cell}) {
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

/// bits() of a range of phi after full turns. Remembers the last ones: in the next row they are mostly the same.
class UnrolledMesh::BitsOfTurns {
 public:
  BitsOfTurns(const UnrolledMesh& mesh, double lo, double hi) : mesh_(mesh), lo_(lo), hi_(hi) {}

  const Bits& operator()(Turns turns) {
    for (const Known& k : known_)
      if (k.turns == turns) return k.bits;
    Known& out = known_[next_++ % known_.size()];
    out = {turns, {}};
    for (long t = turns.first; t <= turns.last; ++t) {
      const double by = 2 * pi * static_cast<double>(t);
      RowRuns::add_to(out.bits, mesh_.bits(lo_ + by, hi_ + by));
    }
    return out.bits;
  }

 private:
  struct Known {
    Turns turns{0, -1};  // none
    Bits bits{};
  };
  const UnrolledMesh& mesh_;
  double lo_, hi_;
  std::array<Known, 3> known_;
  std::size_t next_ = 0;
};

/// For triangles at any angle: with psi reduced to [0, lead), phi determines the height.
UnrolledMesh::Bits UnrolledMesh::bits_of_bent(const Unrolled& u, double from, double to) const {
  const double pitch = lead_ / (2 * pi);
  return bits(u.z_lo / pitch - 2 * pi + from - kAngleSlack, u.z_hi / pitch + to + kAngleSlack);
}

/// Marks what a triangle sweeps.
void UnrolledMesh::ask(const Corners& t, double from, double to, int depth) {
  const Unrolled u = unroll(winding_, t, winding_.off);
  if (!near(u, from, to)) return;
  if (depth > 0 && (u.bent || u.below > wide_.cell)) {
    for (const Corners& q : quarters(t)) ask(q, from, to, depth - 1);
    return;
  }
  if (u.bent) {
    const Bits b = bits_of_bent(u, from, to);
    const auto [row0, row1] = wide_.rows_of(u.r_lo, u.r_hi);
    for (long row = row0; row <= row1; ++row)
      asked_.add(static_cast<std::size_t>(row), 0, static_cast<std::int32_t>(wide_.columns - 1), b);
    return;
  }
  BitsOfTurns bits_of(*this, u.phi_lo + from, u.phi_hi + to);
  wide_.runs_of(
      u, [](long) { return true; },
      [&](std::size_t row, std::int32_t first, std::int32_t last, Turns turns) {
        asked_.add(row, first, last, bits_of(turns));
        return true;
      });
}

/// True unless none of the triangles asked meets this one, which is not bent.
bool UnrolledMesh::is_asked(const Unrolled& u) const {
  BitsOfTurns bits_of(*this, u.phi_lo, u.phi_hi);
  return !wide_.runs_of(
      u, [](long) { return true; },
      [&](std::size_t row, std::int32_t first, std::int32_t last, Turns turns) {
        const Bits b = bits_of(turns);
        return asked_.each(row, first, last, [&](const Bits& asked) { return RowRuns::disjoint(asked, b); });
      });
}

void UnrolledMesh::enter(const Corners& t, int depth) {
  const Unrolled u = unroll(winding_, t, 0);
  if (!near(u) || (!u.bent && !is_asked(u))) return;
  if (depth > 0 && (u.bent || u.below > fine_.cell)) {
    for (const Corners& q : quarters(t)) enter(q, depth - 1);
    return;
  }
  if (u.bent) {
    const Bits b = bits_of_bent(u, 0, 0);
    const auto [row0, row1] = fine_.rows_of(u.r_lo, u.r_hi);
    for (long row = row0; row <= row1; ++row) RowRuns::add_to(by_bent_[static_cast<std::size_t>(row)], b);
    return;
  }
  // What is asked in the row, for any psi.
  const Bits any = bits_of_bent(u, 0, 0);
  const auto asked_in = [&](long row) {
    const long wide = std::min(row / kWide, wide_.rows - 1);
    return !RowRuns::disjoint(asked_.in_row(static_cast<std::size_t>(wide)), any);
  };
  BitsOfTurns bits_of(*this, u.phi_lo, u.phi_hi);
  fine_.runs_of(u, asked_in, [&](std::size_t row, std::int32_t first, std::int32_t last, Turns turns) {
    const Bits b = bits_of(turns);
    taken_.add(row, first, last, b);
    return true;
  });
}

/// True if no triangle of the mesh has any of these bits in a row.
bool UnrolledMesh::none_in(long row, const Bits& bits) const {
  const auto r = static_cast<std::size_t>(row);
  return RowRuns::disjoint(taken_.in_row(r), bits) && RowRuns::disjoint(by_bent_[r], bits);
}

bool UnrolledMesh::free(const Corners& t, double from, double to, int depth, std::uint64_t& cells) const {
  const Unrolled u = unroll(winding_, t, winding_.off);
  ++cells;
  if (!near(u, from, to)) return true;
  // For any psi: is the mesh at these radii and heights at all?
  const Bits any = bits_of_bent(u, from, to);
  const auto [row0, row1] = fine_.rows_of(u.r_lo, u.r_hi);
  bool alone = true;
  for (long row = row0; row <= row1 && alone; ++row) alone = none_in(row, any);
  cells += static_cast<std::uint64_t>(std::max(0L, row1 - row0)) / 4;
  if (alone) return true;
  if (depth > 0 && (u.bent || u.below > fine_.cell)) {
    for (const Corners& q : quarters(t))
      if (!free(q, from, to, depth - 1, cells)) return false;
    return true;
  }
  if (u.bent) return false;
  BitsOfTurns bits_of(*this, u.phi_lo + from, u.phi_hi + to);
  return fine_.runs_of(
      u, [&](long row) { return !none_in(row, any); },
      [&](std::size_t row, std::int32_t first, std::int32_t last, Turns turns) {
        ++cells;
        const Bits b = bits_of(turns);
        return RowRuns::disjoint(by_bent_[row], b) && taken_.each(row, first, last, [&](const Bits& taken) {
          ++cells;
          return RowRuns::disjoint(taken, b);
        });
      });
}

bool UnrolledMesh::clear_of(const Corners& moved, std::size_t from, std::size_t to, std::uint64_t& cells) const {
  if (blind_) return false;
  if (empty_) return true;
  return free(moved, winding_.turned_at(from), winding_.turned_at(to), kDepth, cells);
}

}  // namespace dismantle::geometry
