#include "page_view.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "dismantle/plan_io/base64.h"
#include "dismantle/plan_io/explode.h"
#include "dismantle/plan_io/input_frame.h"
#include "dismantle/plan_io/order_words.h"
#include "dismantle/plan_io/plan_account.h"
#include "dismantle/plan_io/plan_history.h"
#include "explain/reach.h"
#include "page_steps.h"
#include "steps/fewer_poses.h"
#include "steps/timeline.h"

namespace dismantle {
namespace {

using ViewJson = nlohmann::ordered_json;

ViewJson animation_json(const Timeline& line, const std::vector<std::uint32_t>& poses) {
  std::vector<float> times;
  for (const StepTime& step : line.steps) times.insert(times.end(), step.pose_times.begin(), step.pose_times.end());
  return {{"duration", line.duration}, {"times", base64_of(times)}, {"poses", base64_of(poses)}};
}

/// When each step of the plan is over: the end of the last motion up to it.
std::vector<float> ends_of(const Timeline& line, std::size_t steps) {
  std::vector<float> out;
  auto next = line.steps.begin();
  for (std::size_t s = 0; s < steps; ++s) {
    out.push_back(out.empty() ? 0 : out.back());
    if (next != line.steps.end() && next->index == s) out.back() = (next++)->end;
  }
  return out;
}

template <class Value>
ViewJson or_null(const std::optional<Value>& value) {
  return value ? ViewJson(*value) : ViewJson(nullptr);
}

/// Columns, one value per part of the plan. Parts that stay are gone, and parts that are there from the beginning come,
/// at an infinite time.
ViewJson parts_json(const Plan& plan, const Assembly& assembly, const PlanHistory& history, const Timeline& disassembly,
                    const Timeline& together) {
  constexpr float kNever = std::numeric_limits<float>::infinity();
  std::vector<float> gone(history.parts(), kNever), comes(history.parts(), -kNever);
  std::set<std::size_t> seen;
  for (const StepTime& time : together.steps)
    for (const PlanMove& move : plan.assembly_steps[time.index].moves)
      if (const std::size_t i = history.index_of(move.part); seen.insert(i).second)
        if (plan.assembly_steps[time.index].transfer == 0) comes[i] = time.begin;
  const std::vector<float> ends = ends_of(disassembly, history.steps());
  ViewJson rank = ViewJson::array(), out = ViewJson::array();
  for (std::size_t i = 0; i < history.parts(); ++i) {
    const auto step = history.out_in(i);
    rank.push_back(or_null(history.rank(i)));
    out.push_back(or_null(step));
    if (step) gone[i] = ends[*step];
  }
  std::vector<float> offsets;
  for (const Eigen::Vector3d& offset : exploded_offsets(plan, assembly))
    for (const double x : offset) offsets.push_back(static_cast<float>(x));
  return {{"rank", std::move(rank)},
          {"out", std::move(out)},
          {"gone", base64_of(gone)},
          {"comes", base64_of(comes)},
          {"offsets", base64_of(offsets)}};
}

ViewJson reasons_json(const Explanation& why, const Assembly& assembly, const PlanHistory& history) {
  std::map<std::string, Eigen::Vector3d> centers;
  for (const Part& part : assembly.parts)
    centers[part.name] = assembly.normalization.to_input(part.mesh->box().center());
  ViewJson out = ViewJson::array();
  for (const LeftReason& reason : why.left) {
    ViewJson parts = ViewJson::array();
    for (const LeftPart& left : reason.parts) {
      const std::size_t i = history.index_of(left.part);
      const Reach reach =
          reach_of(*why.plan, history.pose_of(i, history.steps()), left.best_pose, centers.at(left.part));
      parts.push_back({{"part", i},
                       {"moved", reach.moved},
                       {"travel", reach.travel},
                       {"turn_degrees", reach.turn * 180 / std::numbers::pi}});
    }
    out.push_back({{"meaning", reason.meaning}, {"parts", std::move(parts)}, {"advice", reason.advice}});
  }
  return out;
}

ViewJson account_json(const Plan& plan) {
  const PlanAccount account = account_of(plan);
  return {{"checked", account.checked},
          {"not_checked", account.not_checked},
          {"assumed", account.assumed},
          {"order", {{"disassembly", cost_words(plan, true)}, {"assembly", cost_words(plan, false)}}}};
}

}  // namespace

DrawnPlan::DrawnPlan(const Plan& whole) : plan(whole) {
  for (auto [steps, numbers] : {std::pair(&plan.disassembly, &disassembly), std::pair(&plan.assembly_steps, &assembly)})
    for (PlanStep& step : *steps) {
      for (const std::size_t k : leave_out_poses(step)) numbers->push_back(static_cast<std::uint32_t>(k));
      for (PlanVerdict& verdict : step.checks) verdict.certificate.reset();
    }
  for (PlanObjectiveItem& item : plan.objective.checks)
    if (item.plan) item.plan->certificate.reset();
}

ViewJson page_view(const Plan& plan, const DrawnPlan& drawn, const Assembly& assembly, const PartShapes& shapes,
                   const ExplainSettings& settings) {
  const PlanHistory history(plan);
  const Timeline disassembly = timeline(drawn.plan.disassembly, assembly, disassembly_ups(plan));
  const Timeline together = timeline(drawn.plan.assembly_steps, assembly, assembly_ups(plan));
  const Explanation why = explain(plan, settings);
  ViewJson untried = ViewJson::array();
  for (const std::string& name : why.untried) untried.push_back(history.index_of(name));
  const Eigen::Vector3d up = input_frame(plan).up;
  return {{"up", {up.x(), up.y(), up.z()}},
          {"leavers", history.leavers()},
          {"account", account_json(plan)},
          {"steps", page_steps(plan)},
          {"runs", page_runs(plan, step_runs(plan, shapes))},
          {"animations",
           {{"disassembly", animation_json(disassembly, drawn.disassembly)},
            {"assembly", animation_json(together, drawn.assembly)}}},
          {"parts", parts_json(plan, assembly, history, disassembly, together)},
          {"reasons", reasons_json(why, assembly, history)},
          {"untried", std::move(untried)}};
}

}  // namespace dismantle
