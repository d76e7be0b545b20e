#include "interlock_lp/pair_rows.h"

#include "dismantle/immobility/free_part.h"
#include "interlock_lp/body_coordinates.h"

namespace dismantle::immobility {
namespace {

using Mat3 = Eigen::Matrix3d;
using Vec3 = Eigen::Vector3d;

constexpr double kRounding = 1e-9;

/// w x p as a function of w.
Mat3 turned_by(const Vec3& p) {
  Mat3 m;
  m << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
  return m;
}

}  // namespace

std::vector<PairRow> pair_rows(const Pinned& pinned, const Eigen::Quaterniond& axes, const Vector6& lo,
                               const Vector6& hi) {
  std::vector<PairRow> rows;
  const Vector6 most = lo.cwiseAbs().cwiseMax(hi.cwiseAbs()), middle = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
  const Vec3 turn = most.head<3>(), shift = most.tail<3>();
  for (const Pin& pin : pinned.pins()) {
    if (pin.room > shift.norm() + turn.norm() * (pin.at.norm() + shift.norm())) continue;
    const Vec3 at = axes.conjugate() * pin.at, p = at.cwiseAbs();
    // of_a: exp(w) p + s = p + w x p + s + w x (w x p) / 2 + ...; else exp(-w) (p - s), likewise.
    Eigen::Matrix<double, 3, 6> slope;
    slope << turned_by(at), Mat3::Identity();
    if (!pin.of_a) slope = -slope;
    const Vec3 arm = pin.of_a ? p : Vec3(p + shift);
    Vec3 rest = 0.5 * cross_most(turn, cross_most(turn, arm));
    if (!pin.of_a) rest += cross_most(turn, shift);
    rest.array() += turn.norm() * turn.squaredNorm() / 6 * arm.norm() + kRounding;

    const Pinned::Faced& faced = pinned.faced(pin);
    const Mat3 to_local = (faced.to_local.q * axes).toRotationMatrix();
    const Vec3 fixed = faced.to_local * Vec3(pin.at + pinned.center());
    const Eigen::Matrix<double, 3, 6> local = to_local * slope;
    const Vec3 local_rest = to_local.cwiseAbs() * rest;
    const FreePart part = free_part(faced, fixed + local * middle, local.cwiseAbs() * half + local_rest);
    for (const HalfSpace& h : part.within)
      rows.push_back(
          {-local.transpose() * h.normal, h.normal.dot(fixed) + h.normal.cwiseAbs().dot(local_rest) - h.least});
  }
  return rows;
}

}  // namespace dismantle::immobility
