#include "page_steps.h"

#include <algorithm>

#include "dismantle/plan_io/input_frame.h"
#include "dismantle/plan_io/motion_words.h"
#include "steps/timeline.h"

namespace dismantle {
namespace {

using StepsJson = nlohmann::ordered_json;

/// One object per step. Without any step that says how the assembly lies, nothing is said of it.
StepsJson steps_json(const StepUps& ups, const InputFrame& frame) {
  StepsJson out = StepsJson::array();
  const bool said = std::ranges::any_of(ups, [](const auto& up) { return up.has_value(); });
  for (std::size_t s = 0; s < ups.size(); ++s) {
    StepsJson step = StepsJson::object();
    if (said) {
      const Eigen::Quaterniond q = frame.lies(ups[s]);
      step["lies"] = {q.w(), q.x(), q.y(), q.z()};
      step["lies_words"] = lie_words(ups[s].value_or(frame.up()), frame.y_up);
      step["turned"] = s > 0 && ups[s] != ups[s - 1];
    }
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
  const InputFrame frame = input_frame(plan.assembly);
  return {{"disassembly", steps_json(disassembly_ups(plan), frame)},
          {"assembly", steps_json(assembly_ups(plan), frame)}};
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
