#include "reorientations.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace dismantle::checks {

void ReorientationsParameters::describe(Schema<ReorientationsParameters>& s) {
  s.add("angle", &ReorientationsParameters::angle,
        {.unit = "rad",
         .min = 0,
         .max = std::numbers::pi,
         .doc = "Orientations whose upward directions differ by no more than this count as the same."});
}

StepVerdict Reorientations::judge(const StepQuestion& question, const RunContext& /*context*/) const {
  StepVerdict verdict;
  if (question.previous == nullptr) return verdict;
  const Eigen::Vector3d &now = question.up, &before = question.previous->up;
  const double angle = std::atan2(now.cross(before).norm(), now.dot(before));
  if (angle <= params_.angle) return verdict;
  const double degrees = angle * 180 / std::numbers::pi;
  verdict.cost = 1;
  verdict.reason = fmt::format("the assembly lies {:.0f} degrees from where it lay in the step before", degrees);
  verdict.notes.push_back(
      {"reorientations",
       degrees > 135 ? "Turn the assembly over." : fmt::format("Turn the assembly by {:.0f} degrees.", degrees),
       fmt::format("{{\"up\": [{}, {}, {}]}}", now.x(), now.y(), now.z())});
  return verdict;
}

}  // namespace dismantle::checks
