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

}  // namespace

StepsJson page_steps(const Plan& plan) {
  const InputFrame frame = input_frame(plan.assembly);
  return {{"disassembly", steps_json(disassembly_ups(plan), frame)},
          {"assembly", steps_json(assembly_ups(plan), frame)}};
}

}  // namespace dismantle
