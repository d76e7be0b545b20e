#include "dismantle/step_check.h"

#include <algorithm>
#include <utility>

namespace dismantle {

namespace {

/// Direction of the last stretch of an insertion: how the centre of the first part moves between the last two poses
/// that differ; of a screw its axis, round which a centre beside it goes. A hinge hardly moves along its axis: it is no
/// screw. Zero for a rotation in place.
Eigen::Vector3d last_direction(const Assembly& assembly, const std::vector<PlacedPart>& moved, const Trace& insertion) {
  const auto& mesh = assembly.parts.at(moved.front().part).mesh;
  const Eigen::Vector3d center = mesh && !mesh->vertices.empty() ? mesh->box().center() : Eigen::Vector3d::Zero();
  for (std::size_t k = insertion.size(); k-- > 1;) {
    const Eigen::Vector3d along = insertion[k].front() * center - insertion[k - 1].front() * center;
    const Eigen::Vector3d axis = (insertion[k].front().q * insertion[k - 1].front().q.conjugate()).vec();
    const double advance = along.dot(axis), least = std::max(0.01 * axis.norm(), 1e-8) * along.norm();
    if (advance * advance > least * least) return (advance * axis).normalized();
    if (along.norm() > 0) return along.normalized();
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace

ObjectiveVerdict Objective::judge(const StepQuestion& question, const RunContext& context, Ask ask) const {
  ObjectiveVerdict all;
  for (std::size_t k = 0; k < items.size(); ++k) {
    all.verdicts.push_back((items[k].check.get()->*ask)(question, context));
    all.cost += items[k].weight * all.verdicts.back().cost;
    if (items[k].require && !all.verdicts.back().allowed && !all.refused) all.refused = k;
  }
  return all;
}

Operation::Operation(const Assembly& assembly, std::vector<PlacedPart> moved, std::vector<PlacedPart> present,
                     Trace removal, const Eigen::Vector3d& up)
    : assembly_(assembly),
      moved_(std::move(moved)),
      present_(std::move(present)),
      insertion_(std::move(removal)),
      up_(up) {
  std::reverse(insertion_.begin(), insertion_.end());
  direction_ = last_direction(assembly_, moved_, insertion_);
}

StepQuestion Operation::question(const StepQuestion* previous) const {
  return {assembly_, moved_, present_, direction_, &insertion_, up_, previous};
}

}  // namespace dismantle
