#include "covers.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace dismantle::checks {

namespace {

constexpr double kSteep = 0.7;    // cosine: within 45 degrees of `up`
constexpr double kMargin = 1e-3;  // relative: what rounding must not decide, as between equal parts

/// Rows: two directions across `up`, along axes if `up` is along one, and `up`.
Eigen::Matrix3d frame_of(const Eigen::Vector3d& up) {
  int axis = 0;
  up.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d u = up.cross(Eigen::Vector3d::Unit(axis)).normalized();
  Eigen::Matrix3d frame;
  frame << u.transpose(), up.cross(u).transpose(), up.transpose();
  return frame;
}

/// Overlap of two boxes along x and y, as a share of the first.
double covered_share(const Aabb& box, const Aabb& cover) {
  double share = 1;
  for (int k = 0; k < 2; ++k) {
    const double common = std::min(box.hi[k], cover.hi[k]) - std::max(box.lo[k], cover.lo[k]),
                 own = box.hi[k] - box.lo[k];
    share *= own > 0 ? std::clamp(common / own, 0.0, 1.0) : 0.0;
  }
  return share;
}

}  // namespace

StepVerdict Covers::judge(const StepQuestion& question, const RunContext& /*context*/) const {
  StepVerdict verdict;
  if (question.moving.empty() || question.direction.isZero()) return verdict;
  // From above the way was open, and from below nothing above is in the way.
  if (std::abs(question.direction.dot(question.up)) > kSteep) return verdict;
  const std::shared_ptr<const geometry::PartBoxes> boxes = boxes_.of(question.assembly);
  const Eigen::Matrix3d frame = frame_of(question.up);
  const Aabb own = boxes->of(question.moving, frame);
  const double middle = own.center().z() + kMargin * own.size().z(), size = geometry::half_surface(own);
  const PlacedPart* cover = nullptr;
  for (const PlacedPart& p : question.present) {
    const Aabb box = boxes->of(p, frame);
    if (box.lo.z() < middle || geometry::half_surface(box) <= (1 + kMargin) * size) continue;
    const double share = covered_share(own, box);
    if (share <= verdict.cost) continue;
    verdict.cost = share;
    cover = &p;
  }
  if (cover == nullptr) return verdict;
  const auto& parts = question.assembly.parts;
  verdict.reason = fmt::format("'{}', which is larger and in place already, covers {:.0f} % of '{}' from above",
                               parts[cover->part].name, 100 * verdict.cost, parts[question.moving.front().part].name);
  return verdict;
}

}  // namespace dismantle::checks
