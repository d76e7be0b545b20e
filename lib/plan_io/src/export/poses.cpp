// Poses with times, as CSV and JSON.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "dismantle/plan_io/csv_text.h"
#include "dismantle/plan_io/exports.h"
#include "dismantle/plan_io/verdicts.h"
#include "json/json_text.h"
#include "json/verdicts_json.h"
#include "steps/timeline.h"

namespace dismantle {
namespace {

/// Rounds to microseconds; smaller digits are noise of the computation.
double shown_time(float seconds) { return std::round(1e6 * static_cast<double>(seconds)) / 1e6; }

std::array<double, 7> numbers_of(const Pose& p) {
  return {p.t.x(), p.t.y(), p.t.z(), p.q.w(), p.q.x(), p.q.y(), p.q.z()};
}

void append_rows(std::string& out, const char* animation, const std::vector<PlanStep>& all, const StepUps& ups,
                 const Assembly& assembly) {
  const Timeline line = timeline(all, assembly, ups);
  for (const StepTime& step : line.steps)
    for (const PlanMove& move : all[step.index].moves)
      for (std::size_t k = 0; k < move.poses.size(); ++k) {
        out += fmt::format("{},{},{},{},{}", animation, step.step, csv_field(move.part), k,
                           number_text(shown_time(step.pose_times[k])));
        for (const double x : numbers_of(move.poses[k])) out += ',' + number_text(x);
        out += '\n';
      }
}

/// `checks_of`: what the objective says of a step.
template <class ChecksOf>
nlohmann::ordered_json poses_of(const std::vector<PlanStep>& all, const StepUps& ups, const Assembly& assembly,
                                ChecksOf checks_of) {
  const Timeline line = timeline(all, assembly, ups);
  auto out = nlohmann::ordered_json::array();
  for (const StepTime& step : line.steps) {
    auto times = nlohmann::ordered_json::array(), moves = nlohmann::ordered_json::array();
    for (const float t : step.pose_times) times.push_back(shown_time(t));
    for (const PlanMove& move : all[step.index].moves) {
      auto poses = nlohmann::ordered_json::array();
      for (const Pose& pose : move.poses) poses.push_back(numbers_of(pose));
      moves.push_back({{"part", move.part}, {"poses", std::move(poses)}});
    }
    out.push_back({{"step", step.step}, {"times", std::move(times)}, {"moves", std::move(moves)}});
    if (const auto& checks = checks_of(all[step.index]); !checks.empty()) out.back()["checks"] = verdicts_json(checks);
  }
  return out;
}

}  // namespace

std::string poses_csv(const Plan& plan, const Assembly& assembly) {
  std::string out = "animation,step,part,pose,time,x,y,z,qw,qx,qy,qz\n";
  append_rows(out, "disassembly", plan.disassembly, disassembly_ups(plan), assembly);
  append_rows(out, "assembly", plan.assembly_steps, assembly_ups(plan), assembly);
  return out;
}

std::string poses_json(const Plan& plan, const Assembly& assembly, const InputFrame& frame) {
  nlohmann::ordered_json out = {{"format", "dismantle.poses"}, {"version", 1}, {"source", plan.assembly.source}};
  out["unit"] = frame.unit_known ? nlohmann::ordered_json(frame.unit) : nlohmann::ordered_json(nullptr);
  out["disassembly"] = poses_of(
      plan.disassembly, disassembly_ups(plan), assembly, [](const PlanStep& s) -> const auto& { return s.checks; });
  out["assembly"] = poses_of(
      plan.assembly_steps, assembly_ups(plan),
      assembly, [&](const PlanStep& s) -> const auto& { return checks_of_assembly_step(plan, s); });
  return json_text(out) + "\n";
}

}  // namespace dismantle
