#include "directions.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace dismantle::checks {

namespace {

using Eigen::Vector3d;

double angle_of(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// How little a direction is liked, in [0, 1], and the words for it. Main axes: `up`, and the axes of the assembly.
std::pair<double, const char*> dislike(const Vector3d& direction, const Vector3d& up, double angle) {
  if (angle_of(direction, -up) <= angle) return {0, ""};
  if (angle_of(direction, up) <= angle) return {2.0 / 3, "it is put in from below"};
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0})
      if (angle_of(direction, sign * Vector3d::Unit(axis)) <= angle) return {1.0 / 3, "it is put in from the side"};
  return {1, "it is put in along no main axis"};
}

}  // namespace

void DirectionsParameters::describe(Schema<DirectionsParameters>& s) {
  s.add("angle", &DirectionsParameters::angle,
        {.unit = "rad",
         .min = 0,
         .max = std::numbers::pi,
         .doc = "Directions of insertion that differ by no more than this count as the same."});
  s.add("preference", &DirectionsParameters::preference,
        {.unit = "1",
         .min = 0,
         .doc = "Cost of a direction along no main axis; from below two thirds of it, from the side one third, from "
                "above nothing."});
}

StepVerdict Directions::judge(const StepQuestion& question, const RunContext& /*context*/) const {
  StepVerdict verdict;
  const Vector3d& now = question.direction;
  if (now.isZero()) return verdict;
  if (question.previous != nullptr && !question.previous->direction.isZero()) {
    const double angle = angle_of(now, question.previous->direction);
    if (angle > params_.angle) {
      verdict.cost = 1;
      verdict.reason = fmt::format("the direction of insertion differs by {:.0f} degrees from that of the step before",
                                   angle * 180 / std::numbers::pi);
    }
  }
  if (params_.preference > 0)
    if (const auto [share, text] = dislike(now, question.up, params_.angle); share > 0) {
      verdict.cost += params_.preference * share;
      verdict.reason += verdict.reason.empty() ? text : fmt::format("; {}", text);
    }
  return verdict;
}

}  // namespace dismantle::checks
