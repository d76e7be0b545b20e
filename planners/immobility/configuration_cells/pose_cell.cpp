#include "configuration_cells/pose_cell.h"

#include <algorithm>
#include <cmath>

#include "dismantle/immobility/free_part.h"

namespace dismantle::immobility {
namespace {

using Mat3 = Eigen::Matrix3d;
using Vec3 = Eigen::Vector3d;

constexpr int kRounds = 6;
constexpr double kAgain = 0.8;        // of some width left over: once more
constexpr double kWorthwhile = 0.95;  // half spaces that cut off less of the cell are left out
constexpr double kLeastMove = 1e-3;   // of the width, of a face
constexpr double kRounding = 1e-9;

/// d/dw exp(w) p = (J e_i) x exp(w) p.
Mat3 left_jacobian(const Vec3& w) {
  const double t = w.norm();
  Mat3 k;
  k << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  const double a = t < 1e-4 ? 0.5 - t * t / 24 : (1 - std::cos(t)) / (t * t);
  const double b = t < 1e-4 ? 1.0 / 6 - t * t / 120 : (t - std::sin(t)) / (t * t * t);
  return Mat3::Identity() + a * k + b * k * k;
}

/// Columns (J e_i) x p.
Mat3 turning(const Mat3& jacobian, const Vec3& p) {
  Mat3 m;
  for (int i = 0; i < 3; ++i) m.col(i) = jacobian.col(i).cross(p);
  return m;
}

/// Where a pin is over a cell, in the frame of the solid that it faces: at + slope * (x - centre), and no more than
/// `rest` from there; all that is within the box at +- half.
struct Spread {
  Vec3 at, half;
  Eigen::Matrix<double, 3, 6> slope;
  double rest = 0;
};

class View {
 public:
  View(const PoseCell& cell, const Pinned& pinned) : pinned_(pinned) {
    const Vector6 middle = cell.center();
    half_ = 0.5 * cell.size();
    const Vec3 w = middle.head<3>();
    turn_ = rotation_from_vector(w).toRotationMatrix();
    shift_ = middle.tail<3>();
    there_ = left_jacobian(w);
    back_ = left_jacobian(-w);
    turn_reach_ = half_.head<3>().norm();
    shift_reach_ = half_.tail<3>().norm();
  }

  Spread spread(const Pin& pin) const {
    const Pinned::Faced& faced = pinned_.faced(pin);
    const Mat3& f = faced.turn;
    Spread s;
    Vec3 p;
    if (pin.of_a) {
      const Vec3 turned = turn_ * pin.at;
      p = turned + shift_;
      s.slope << f * turning(there_, turned), f;
      s.rest = 0.5 * turn_reach_ * turn_reach_ * pin.at.norm();
    } else {
      // exp(-w) (at - shift): the turn and the shift multiply.
      const Vec3 from = pin.at - shift_;
      p = turn_.transpose() * from;
      s.slope << -f * turning(back_, p), -f * turn_.transpose();
      s.rest = 0.5 * turn_reach_ * turn_reach_ * from.norm() + turn_reach_ * shift_reach_;
    }
    s.rest += kRounding;
    s.at = f * (p + pinned_.center()) + faced.to_local.t;
    s.half = s.slope.cwiseAbs() * half_;
    s.half.array() += s.rest;
    return s;
  }

 private:
  const Pinned& pinned_;
  Vector6 half_;
  Mat3 turn_, there_, back_;
  Vec3 shift_;
  double turn_reach_, shift_reach_;
};

/// The half spaces of all pins, from the cell's centre. Nothing: the cell is empty.
bool gather(PoseCell& cell, const Pinned& pinned, Polytope& polytope) {
  const View view(cell, pinned);
  const Vector6 reach = 0.5 * cell.size();
  polytope.lo = -reach;
  polytope.hi = reach;
  polytope.a.clear();
  polytope.b.clear();
  auto kept = std::make_shared<PinList>();
  cell.center_open = true;
  for (const std::uint32_t number : *cell.pins) {
    const Pin& pin = pinned.pins()[number];
    const Pinned::Faced& faced = pinned.faced(pin);
    const Spread s = view.spread(pin);
    const FreePart part = free_part(faced, s.at, s.half);
    if (part.none) return false;
    if (part.all) continue;
    kept->push_back(number);
    if (cell.center_open && faced.occupied.inside(s.at)) cell.center_open = false;
    for (const HalfSpace& h : part.within) {
      const Vector6 a = -s.slope.transpose() * h.normal;
      const double b = h.normal.dot(s.at) + s.rest - h.least, most = a.cwiseAbs().dot(reach);
      if (b < -most) return false;
      if (b < kWorthwhile * most) polytope.add(a, b);
    }
  }
  cell.pins = std::move(kept);
  return true;
}

/// Moves the faces in as far as the half spaces allow. Nothing: they have nothing in common.
bool shrink(PoseCell& cell, Polytope& polytope) {
  const Vector6 middle = cell.center(), size = cell.size();
  for (int d = 0; d < 6; ++d)
    for (const bool upper : {false, true}) {
      const LinearBound m = maximum(Vector6((upper ? 1.0 : -1.0) * Vector6::Unit(d)), polytope);
      if (m.empty) return false;
      const double by = m.value + kRounding;
      if (upper && by < polytope.hi[d] - kLeastMove * size[d]) {
        polytope.hi[d] = by;
        cell.hi[d] = middle[d] + by;
      } else if (!upper && -by > polytope.lo[d] + kLeastMove * size[d]) {
        polytope.lo[d] = -by;
        cell.lo[d] = middle[d] - by;
      }
      if (polytope.lo[d] > polytope.hi[d]) return false;
    }
  return true;
}

}  // namespace

bool PoseCell::touches(const PoseCell& other) const {
  for (int d = 0; d < 6; ++d)
    if (lo[d] > other.hi[d] || hi[d] < other.lo[d]) return false;
  return true;
}

void contract(PoseCell& cell, const Pinned& pinned, const PinList& in_use) {
  if (cell.known < in_use.size()) {
    auto more = std::make_shared<PinList>(*cell.pins);
    more->insert(more->end(), in_use.begin() + static_cast<std::ptrdiff_t>(cell.known), in_use.end());
    cell.pins = std::move(more);
    cell.known = in_use.size();
  }
  static thread_local Polytope polytope;
  for (int round = 0; round < kRounds; ++round) {
    const Vector6 before = cell.size();
    if (!gather(cell, pinned, polytope) || !shrink(cell, polytope)) {
      cell.empty = true;
      cell.pins.reset();
      return;
    }
    if (!(cell.size().cwiseQuotient(before).minCoeff() < kAgain)) return;
  }
}

}  // namespace dismantle::immobility
