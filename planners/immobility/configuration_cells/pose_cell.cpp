#include "configuration_cells/pose_cell.h"

#include <algorithm>
#include <cmath>

#include "dismantle/immobility/free_space_bound.h"

namespace dismantle::immobility {
namespace {

using Mat3 = Eigen::Matrix3d;
using Vec3 = Eigen::Vector3d;

/// d/dw exp(w) p = (J e_i) x exp(w) p.
Mat3 left_jacobian(const Vec3& w) {
  const double t = w.norm();
  Mat3 k;
  k << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  const double a = t < 1e-4 ? 0.5 - t * t / 24 : (1 - std::cos(t)) / (t * t);
  const double b = t < 1e-4 ? 1.0 / 6 - t * t / 120 : (t - std::sin(t)) / (t * t * t);
  return Mat3::Identity() + a * k + b * k * k;
}

/// Derivative of exp(w) p: columns (J e_i) x p.
Mat3 derivative(const Mat3& jacobian, const Vec3& p) {
  Mat3 m;
  for (int i = 0; i < 3; ++i) m.col(i) = jacobian.col(i).cross(p);
  return m;
}

/// Positions of a sample over a cell, in the frame of its obstacle: within `rest` of at + slope * (x - centre), and
/// within the box at +- half.
struct Positions {
  Vec3 at, half;
  Eigen::Matrix<double, 3, 6> slope;
  double rest = 0;
};

class Linearization {
 public:
  Linearization(const PoseCell& cell, const SampledPair& pair) : pair_(pair) {
    const Vector6 middle = cell.center();
    half_ = 0.5 * cell.size();
    const Vec3 w = middle.head<3>();
    rotation_ = rotation_from_vector(w).toRotationMatrix();
    shift_ = middle.tail<3>();
    there_ = left_jacobian(w);
    back_ = left_jacobian(-w);
    half_turn_ = half_.head<3>().norm();
    half_shift_ = half_.tail<3>().norm();
  }

  Positions positions(const InteriorSample& sample) const {
    const SampledPair::Obstacle& obstacle = pair_.obstacle(sample);
    const Mat3& f = obstacle.rotation;
    Positions s;
    Vec3 p;
    if (sample.of_a) {
      const Vec3 turned = rotation_ * sample.at;
      p = turned + shift_;
      s.slope << f * derivative(there_, turned), f;
      s.rest = 0.5 * half_turn_ * half_turn_ * sample.at.norm();
    } else {
      // exp(-w) (at - shift): the product of rotation and shift is of second order, too.
      const Vec3 from = sample.at - shift_;
      p = rotation_.transpose() * from;
      s.slope << -f * derivative(back_, p), -f * rotation_.transpose();
      s.rest = 0.5 * half_turn_ * half_turn_ * from.norm() + half_turn_ * half_shift_;
    }
    s.rest += obstacle.rounding;
    s.at = f * (p + pair_.center()) + obstacle.to_local.t;
    s.half = s.slope.cwiseAbs() * half_;
    s.half.array() += s.rest;
    return s;
  }

 private:
  const SampledPair& pair_;
  Vector6 half_;
  Mat3 rotation_, there_, back_;
  Vec3 shift_;
  double half_turn_, half_shift_;
};

/// The half spaces of a cell, relative to its centre.
struct Rows {
  Polytope polytope;
  std::vector<Reason> sources;  ///< of the rows of the polytope; no multipliers
  Multipliers multipliers;      ///< buffer

  std::vector<Reason> reasons() const {
    std::vector<Reason> found;
    for (const auto& [row, y] : multipliers) found.push_back({sources[row].sample, sources[row].source, y});
    return found;
  }
};

/// Collects the half spaces of all samples. False: the cell is empty.
bool gather(PoseCell& cell, const SampledPair& pair, Rows& rows, std::vector<FaceMove>& moves) {
  Polytope& polytope = rows.polytope;
  const Linearization linear(cell, pair);
  const Vector6 reach = 0.5 * cell.size();
  polytope.lo = -reach;
  polytope.hi = reach;
  polytope.a.clear();
  polytope.b.clear();
  rows.sources.clear();
  auto kept = std::make_shared<SampleList>();
  cell.center_free = true;
  for (const std::uint32_t number : *cell.samples) {
    const InteriorSample& sample = pair.samples()[number];
    const SampledPair::Obstacle& obstacle = pair.obstacle(sample);
    const Positions s = linear.positions(sample);
    const FreeSpaceBound free = free_space_bound(obstacle, s.at, s.half);
    if (free.none) {
      moves.push_back({FaceMove::kEmpty, 0, {{number, 0, 1.0}}});
      return false;
    }
    if (free.all) continue;
    kept->push_back(number);
    if (cell.center_free && obstacle.occupied.inside(s.at)) cell.center_free = false;
    for (const HalfSpace& h : free.half_spaces) {
      const Vector6 a = -s.slope.transpose() * h.normal;
      const double b = h.normal.dot(s.at) + s.rest - h.least, most = a.cwiseAbs().dot(reach);
      if (b < -most) {
        moves.push_back({FaceMove::kEmpty, 0, {{number, h.source, 1.0}}});
        return false;
      }
      if (!(b < 0.95 * most)) continue;  // a row that cuts off less is not worth its time
      polytope.add(a, b);
      rows.sources.push_back({number, h.source});
    }
  }
  cell.samples = std::move(kept);
  return true;
}

/// Rounds multipliers to few decimal digits: any that are not negative prove a bound.
void shorten(Multipliers& multipliers) {
  for (auto& [row, y] : multipliers) {
    const double unit = std::pow(10, 5 - std::ceil(std::log10(y)));
    if (std::isfinite(unit)) y = std::round(y * unit) / unit;
  }
}

/// Upper bound of direction . x from the multipliers.
double bound_of(const Vector6& direction, const Rows& rows) {
  Vector6 left = direction;
  double sum = 0;
  for (const auto& [row, y] : rows.multipliers) {
    left -= y * rows.polytope.a[row];
    sum += y * rows.polytope.b[row];
  }
  return sum + left.cwiseProduct(rows.polytope.lo).cwiseMax(left.cwiseProduct(rows.polytope.hi)).sum();
}

/// The next number with few decimal digits that is at least 1e-7 of the width above x.
double rounded_up(double x, double width) {
  const double unit = std::pow(10, std::ceil(6 - std::log10(width)));
  return std::isfinite(unit) ? std::ceil((x + 1e-7 * width) * unit) / unit : x;
}

/// Moves the faces inwards as far as the half spaces allow. False: the half spaces have no common point.
bool shrink(PoseCell& cell, Rows& rows, std::vector<FaceMove>& moves) {
  const Vector6 middle = cell.center(), size = cell.size();
  Polytope& polytope = rows.polytope;
  for (int d = 0; d < 6; ++d)
    for (const bool upper : {false, true}) {
      const Vector6 direction = (upper ? 1.0 : -1.0) * Vector6::Unit(d);
      const LinearBound m = maximum(direction, polytope, nullptr, &rows.multipliers);
      if (m.empty) {
        moves.push_back({FaceMove::kEmpty, 0, rows.reasons()});
        return false;
      }
      if (!std::isfinite(m.value)) continue;
      shorten(rows.multipliers);
      const double side = upper ? 1.0 : -1.0, middle_of = side * middle[d];
      const double most = rounded_up(middle_of + bound_of(direction, rows), size[d]);
      // A face that would move by less than a thousandth of the width stays, and is still shared with the neighbours.
      if (!(most < side * (upper ? cell.hi : cell.lo)[d] - 1e-3 * size[d])) continue;
      (upper ? cell.hi : cell.lo)[d] = side * most;
      (upper ? polytope.hi : polytope.lo)[d] = side * most - middle[d];
      moves.push_back({2 * d + (upper ? 1 : 0), side * most, rows.reasons()});
      if (cell.lo[d] > cell.hi[d]) return false;
    }
  return true;
}

}  // namespace

bool PoseCell::touches(const PoseCell& other) const {
  for (int d = 0; d < 6; ++d)
    if (lo[d] > other.hi[d] || hi[d] < other.lo[d]) return false;
  return true;
}

void contract(PoseCell& cell, const SampledPair& pair, const SampleList& active, Contraction& made) {
  if (cell.known < active.size()) {
    auto more = std::make_shared<SampleList>(*cell.samples);
    more->insert(more->end(), active.begin() + static_cast<std::ptrdiff_t>(cell.known), active.end());
    cell.samples = std::move(more);
    cell.known = active.size();
  }
  static thread_local Rows rows;
  // A smaller cell has a smaller remainder, so contraction is repeated while some width shrinks by a fifth.
  for (int round = 0; round < 6; ++round) {
    const Vector6 before = cell.size();
    std::vector<FaceMove>& moves = made.emplace_back();
    if (!gather(cell, pair, rows, moves) || !shrink(cell, rows, moves)) {
      cell.empty = true;
      cell.samples.reset();
      return;
    }
    if (!(cell.size().cwiseQuotient(before).minCoeff() < 0.8)) return;
  }
}

}  // namespace dismantle::immobility
