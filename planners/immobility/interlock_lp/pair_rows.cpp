#include "interlock_lp/pair_rows.h"

#include "dismantle/immobility/free_space_bound.h"
#include "interlock_lp/relative_coordinates.h"

namespace dismantle::immobility {
namespace {

using Mat3 = Eigen::Matrix3d;
using Vec3 = Eigen::Vector3d;

/// The matrix of w -> w x p.
Mat3 turned_by(const Vec3& p) {
  Mat3 m;
  m << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
  return m;
}

}  // namespace

std::vector<PairRow> pair_rows(const SampledPair& pair, const Eigen::Quaterniond& axes, const Vector6& lo,
                               const Vector6& hi) {
  std::vector<PairRow> rows;
  const Vector6 most = lo.cwiseAbs().cwiseMax(hi.cwiseAbs()), middle = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
  const Vec3 turn = most.head<3>(), shift = most.tail<3>();
  for (const InteriorSample& sample : pair.samples()) {
    if (sample.clearance > shift.norm() + turn.norm() * (sample.at.norm() + shift.norm())) continue;
    const Vec3 at = axes.conjugate() * sample.at, p = at.cwiseAbs();
    // of_a: exp(w) p + s = p + w x p + s + w x (w x p) / 2 + ...; else exp(-w) (p - s), expanded in the same way.
    Eigen::Matrix<double, 3, 6> slope;
    slope << turned_by(at), Mat3::Identity();
    if (!sample.of_a) slope = -slope;
    const Vec3 arm = sample.of_a ? p : Vec3(p + shift);
    Vec3 rest = 0.5 * abs_cross_bound(turn, abs_cross_bound(turn, arm));
    if (!sample.of_a) rest += abs_cross_bound(turn, shift);
    rest.array() += turn.norm() * turn.squaredNorm() / 6 * arm.norm() + pair.obstacle(sample).rounding;

    const SampledPair::Obstacle& obstacle = pair.obstacle(sample);
    const Mat3 to_local = (obstacle.to_local.q * axes).toRotationMatrix();
    const Vec3 fixed = obstacle.to_local * Vec3(sample.at + pair.center());
    const Eigen::Matrix<double, 3, 6> local = to_local * slope;
    const Vec3 local_rest = to_local.cwiseAbs() * rest;
    const FreeSpaceBound free =
        free_space_bound(obstacle, fixed + local * middle, local.cwiseAbs() * half + local_rest);
    for (const HalfSpace& h : free.half_spaces)
      rows.push_back({-local.transpose() * h.normal,
                      h.normal.dot(fixed) + h.normal.cwiseAbs().dot(local_rest) - h.least, &sample,
                      obstacle.to_local.q.conjugate() * h.normal});
  }
  return rows;
}

}  // namespace dismantle::immobility
