#include "page_steps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "dismantle/plan_io/drawn_tools.h"
#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/input_frame.h"
#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/order_words.h"
#include "dismantle/plan_io/thread_words.h"
#include "dismantle/plan_io/verdicts.h"
#include "steps/timeline.h"

namespace dismantle {
namespace {

using StepsJson = nlohmann::ordered_json;

/// Parts that notes name in `{"hold": [{"part": NAME, ...}]}`, as indices. Notes are those of any step check: data of
/// another form say nothing of parts.
class Holds {
 public:
  explicit Holds(const Plan& plan) {
    for (std::size_t i = 0; i < plan.assembly.parts.size(); ++i) index_.emplace(plan.assembly.parts[i].name, i);
  }

  std::optional<std::size_t> index(const std::string& part) const {
    const auto known = index_.find(part);
    return known == index_.end() ? std::nullopt : std::optional(known->second);
  }
  std::set<std::size_t> of(const std::vector<PlanVerdict>& checks) const {
    std::set<std::size_t> out;
    for (const PlanVerdict& verdict : checks)
      for (const StepNote& note : verdict.notes) {
        const StepsJson data = StepsJson::parse(note.data, nullptr, false);
        if (!data.is_object() || !data.contains("hold") || !data["hold"].is_array()) continue;
        for (const StepsJson& held : data["hold"]) {
          if (!held.is_object() || !held.contains("part") || !held["part"].is_string()) continue;
          const auto known = index_.find(held["part"].get<std::string>());
          if (known != index_.end()) out.insert(known->second);
        }
      }
    return out;
  }

 private:
  std::map<std::string, std::size_t> index_;
};

StepsJson prisms_json(const std::vector<ToolPrism>& prisms) {
  const auto mm = [](double x) { return std::round(1000 * x) / 1000 + 0.0; };
  StepsJson out = StepsJson::array();
  for (const ToolPrism& prism : prisms) {
    StepsJson outline = StepsJson::array();
    for (const Eigen::Vector2d& p : prism.outline) outline.insert(outline.end(), {mm(p.x()), mm(p.y())});
    out.push_back(
        {{"outline", std::move(outline)}, {"inner", mm(prism.inner)}, {"z", {mm(prism.low), mm(prism.high)}}});
  }
  return out;
}

/// The tools that notes of a step put in their place.
StepsJson tools_json(const std::vector<PlanVerdict>& checks, const Holds& parts) {
  StepsJson out = StepsJson::array();
  const auto point = [](const Eigen::Vector3d& p) { return StepsJson{p.x(), p.y(), p.z()}; };
  for (const DrawnTool& tool : drawn_tools(checks)) {
    const auto part = parts.index(tool.part);
    if (!part) continue;
    out.push_back({{"part", *part},
                   {"name", tool.name},
                   {"turns", tool.turns},
                   {"origin", point(tool.origin)},
                   {"axis", point(tool.axis)},
                   {"x", point(tool.x)},
                   {"mm", tool.mm},
                   {"swing", tool.swing},
                   {"travel", tool.travel},
                   {"tool", prisms_json(tool.tool)},
                   {"hand", prisms_json(tool.hand)}});
  }
  return out;
}

/// One object per step; `checks_of`: what the objective says of a step; `how_far`: reached_text() of a step; `order`:
/// order_words() of it. Without any step that says how the assembly lies, nothing is said of it.
template <class ChecksOf, class HowFar, class OrderOf>
StepsJson steps_json(const Plan& plan, const std::vector<PlanStep>& steps, const StepUps& ups, ChecksOf checks_of,
                     HowFar how_far, OrderOf order) {
  const InputFrame frame = input_frame(plan);
  const Holds holds(plan);
  StepsJson out = StepsJson::array();
  const bool said = std::ranges::any_of(ups, [](const auto& up) { return up.has_value(); });
  for (std::size_t s = 0; s < ups.size(); ++s) {
    StepsJson step = StepsJson::object();
    if (said) {
      const Eigen::Quaterniond q = frame.lies(ups[s]);
      step["lies"] = {q.w(), q.x(), q.y(), q.z()};
      step["lies_words"] = lie_words(ups[s].value_or(frame.up), frame.up);
      step["turned"] = s > 0 && ups[s] != ups[s - 1];
    }
    if (const auto held = holds.of(checks_of(steps[s])); !held.empty()) step["hold"] = held;
    if (const auto threads = thread_words(plan, steps[s]); !threads.empty()) step["threads"] = threads;
    if (const std::string far = how_far(steps[s]); !far.empty()) step["how_far"] = far;
    if (const std::string words = order(steps[s]); !words.empty()) step["order"] = words;
    if (StepsJson tools = tools_json(checks_of(steps[s]), holds); !tools.empty()) step["tools"] = std::move(tools);
    out.push_back(std::move(step));
  }
  return out;
}

/// A run of several steps: indices into the steps of its animation.
void add_run(StepsJson& out, std::size_t first, std::size_t count, const std::string& words) {
  if (count > 1) out.push_back({{"first", first}, {"count", count}, {"words", words}});
}

}  // namespace

StepsJson page_steps(const Plan& plan) {
  const auto own = [](const PlanStep& step) -> const auto& { return step.checks; };
  const auto reversed = [&](const PlanStep& step) -> const auto& { return checks_of_assembly_step(plan, step); };
  const TextUnit unit = length_unit(plan);
  const auto far = [&](const PlanStep& step) { return reached_text(plan, unit, step); };
  const auto far_back = [&](const PlanStep& step) {
    const std::size_t n = plan.disassembly.size();
    return step.step >= 1 && step.step <= n ? far(plan.disassembly[n - step.step]) : std::string();
  };
  const auto order = [&](const PlanStep& step) { return order_words(plan, step.step - 1, true); };
  const auto order_back = [&](const PlanStep& step) {
    const std::size_t n = plan.disassembly.size();
    return step.step >= 1 && step.step <= n ? order_words(plan, n - step.step, false) : std::string();
  };
  return {{"disassembly", steps_json(plan, plan.disassembly, disassembly_ups(plan), own, far, order)},
          {"assembly", steps_json(plan, plan.assembly_steps, assembly_ups(plan), reversed, far_back, order_back)}};
}

StepsJson page_runs(const Plan& plan, const std::vector<StepRun>& runs) {
  StepsJson apart = StepsJson::array(), back = StepsJson::array();
  const std::size_t n = plan.disassembly.size(), m = plan.assembly_steps.size();
  std::vector<std::size_t> run_of(n);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (std::size_t s = runs[r].first; s < runs[r].first + runs[r].count; ++s) run_of[s] = r;
    add_run(apart, runs[r].first, runs[r].count, run_words(plan, runs[r]));
  }
  // A step of the assembly belongs to the run of the step that it reverses.
  const auto reversed = [&](std::size_t k) { return n - plan.assembly_steps[k].step; };
  for (std::size_t k = 0, end = 0; k < m; k = end) {
    end = k + 1;
    if (reversed(k) >= n) continue;
    while (end < m && reversed(end) < n && run_of[reversed(end)] == run_of[reversed(k)]) ++end;
    add_run(back, k, end - k, run_words(plan, {reversed(end - 1), end - k}));
  }
  return {{"disassembly", std::move(apart)}, {"assembly", std::move(back)}};
}

}  // namespace dismantle
