#include "revision_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "dismantle/plan_io/text_columns.h"

namespace dismantle::app {

std::string kept_text(const KeptSteps& kept, const std::string& plan) {
  const auto count = std::ranges::count_if(kept.revisions, [](const StepRevision& r) { return r.kept; });
  std::string out =
      fmt::format("{} of {} of {} still hold\n", count, text::counted(kept.revisions.size(), "step"), plan);
  for (const StepRevision& r : kept.revisions)
    if (!r.kept) out += fmt::format("  step {} ({}) does not: {}\n", r.step, text::joined(r.parts), r.reason);
  return out;
}

nlohmann::ordered_json revised_json(const KeptSteps& kept) {
  auto out = nlohmann::ordered_json::array();
  for (const StepRevision& r : kept.revisions) {
    out.push_back({{"step", r.step}, {"parts", r.parts}, {"kept", r.kept}});
    if (!r.kept) out.back()["reason"] = r.reason;
  }
  return out;
}

}  // namespace dismantle::app
