#include "directions.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace dismantle::checks {

void DirectionsParams::describe(Schema<DirectionsParams>& s) {
  s.add("angle", &DirectionsParams::angle,
        {.unit = "rad",
         .min = 0,
         .max = std::numbers::pi,
         .doc = "Directions of insertion that differ by no more than this count as the same."});
}

StepVerdict Directions::judge(const StepQuestion& question, const RunContext& /*context*/) const {
  StepVerdict verdict;
  if (question.previous == nullptr) return verdict;
  const Eigen::Vector3d &now = question.direction, &before = question.previous->direction;
  if (now.isZero() || before.isZero()) return verdict;
  const double angle = std::atan2(now.cross(before).norm(), now.dot(before));
  if (angle <= params_.angle) return verdict;
  verdict.cost = 1;
  verdict.reason = fmt::format("the direction of insertion differs by {:.0f} degrees from that of the step before",
                               angle * 180 / std::numbers::pi);
  return verdict;
}

}  // namespace dismantle::checks
