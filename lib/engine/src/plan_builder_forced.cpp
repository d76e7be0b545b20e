// Forced steps of a plan: what no oracle has accepted.
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "plan_builder.h"

namespace dismantle {

void PlanBuilder::force(const std::vector<PartId>& parts, const Path& path, const MotionDepth& worst, double seconds) {
  std::vector<PartId>& group = group_of(parts);
  const auto moves = [&](PartId id) { return std::find(parts.begin(), parts.end(), id) != parts.end(); };
  std::vector<PartId> rest;
  std::copy_if(group.begin(), group.end(), std::back_inserter(rest), [&](PartId id) { return !moves(id); });
  if (rest.empty()) throw std::logic_error("a forced step that leaves nothing behind");
  AttemptResult no_answer;  // the constraints are checked on what moves
  check_constraints({parts, &no_answer}, rest);

  const Normalization& to = assembly_.normalization;
  const InitialOverlap* overlap = assembly_.overlap_of(worst.part, worst.other);
  PlanStep step;
  step.step = static_cast<unsigned>(plan_.disassembly.size()) + 1;
  step.separates.emplace_back();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    PlanMove move{assembly_.parts[parts[i]].name, {}};
    for (const auto& instant : path) move.poses.push_back(to.pose_to_input(instant[i]));
    step.separates.back().push_back(move.part);
    step.moves.push_back(std::move(move));
    poses_[parts[i]] = path.back()[i];
  }
  step.seconds = seconds;
  step.planner = "forced";
  step.depth = 1;
  step.contacts = {assembly_.parts.at(worst.other).name};
  step.forced = PlanForced{assembly_.parts.at(worst.part).name,
                           assembly_.parts.at(worst.other).name,
                           worst.depth / to.scale,
                           (overlap == nullptr ? 0 : overlap->depth) / to.scale,
                           to.to_input(worst.point),
                           {}};
  for (const PlanUnsolved& u : plan_.unsolved)
    if (std::any_of(parts.begin(), parts.end(), [&](PartId id) { return assembly_.parts[id].name == u.part; })) {
      step.forced->reason = u.message.empty() ? std::string(to_string(u.outcome)) : u.message;
      step.forced->certificate = u.certificate;
      if (u.certificate) break;
    }

  const auto from = static_cast<std::size_t>(&group - groups_.data());
  plan_.assembly_steps.insert(plan_.assembly_steps.begin(), reversed(step));
  plan_.disassembly.push_back(std::move(step));
  for (std::size_t i = 0; i < plan_.assembly_steps.size(); ++i)
    plan_.assembly_steps[i].step = static_cast<unsigned>(i) + 1;
  recorded_.push_back({parts, from, std::make_shared<const Path>(path), false, {}});
  groups_[from] = std::move(rest);
  groups_.push_back(parts);
  ++forced_;
  refresh_status();
}

void PlanBuilder::drop_solved() {
  const std::vector<PartId> together = left();
  std::erase_if(plan_.unsolved, [&](const PlanUnsolved& u) {
    return std::none_of(together.begin(), together.end(),
                        [&](PartId id) { return assembly_.parts[id].name == u.part; });
  });
}

std::vector<std::vector<PlacedPart>> PlanBuilder::open_groups() const {
  std::vector<std::vector<PlacedPart>> open;
  if (fulfilled()) return open;
  for (const auto& group : groups_) {
    if (stays_together(group)) continue;
    std::vector<PlacedPart> placed;
    for (const PartId id : group) placed.push_back({id, poses_[id]});
    std::sort(placed.begin(), placed.end(), [](const PlacedPart& a, const PlacedPart& b) { return a.part < b.part; });
    open.push_back(std::move(placed));
  }
  return open;
}

}  // namespace dismantle
