#include "plan_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "command.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/summary.h"

namespace dismantle::app {
namespace {

namespace fs = std::filesystem;

bool any_crash(const RunResult& result) {
  return result.outcome == Outcome::crashed ||
         std::ranges::any_of(result.plan.unsolved, [](const PlanUnsolved& u) { return u.outcome == Outcome::crashed; });
}

nlohmann::ordered_json counters_json(const RunResult& result) {
  nlohmann::ordered_json out = {{"searches", result.counts.attempts},
                                {"remembered", result.counts.memoised},
                                {"proposed", result.counts.proposed},
                                {"refused", result.counts.refused}};
  for (const auto& [name, count] : result.sequence_counts)
    if (count == std::floor(count) && std::abs(count) < 1e15)
      out[name] = static_cast<std::int64_t>(count);
    else
      out[name] = count;
  return out;
}

}  // namespace

std::vector<std::string> unusable_parts(const Plan& plan) {
  std::vector<std::string> names;
  for (const PlanExcluded& part : plan.assembly.excluded)
    if (part.unusable) names.push_back(part.name);
  return names;
}

nlohmann::ordered_json reason_of(const Plan& plan) {
  if (plan.succeeded()) return nullptr;
  if (plan.status == PlanStatus::partial) return "parts_left";
  return plan.status == PlanStatus::forced ? "forced" : "unusable";
}

nlohmann::ordered_json asked_json(const PlanAsked& asked) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  if (!asked.part.empty()) out["part"] = asked.part;
  if (!asked.target.empty()) out["target"] = asked.target;
  if (!asked.together.empty()) out["together"] = asked.together;
  return out;
}

int status_of(const RunResult& result, const RunContext& context) {
  if (result.plan.succeeded()) return kComplete;
  if (result.plan.status == PlanStatus::partial && context.cancel.cancelled()) return kInterrupted;
  return any_crash(result) ? kPluginFailed : kPartial;
}

nlohmann::ordered_json result_json(const RunResult& result, int status, const fs::path& plan) {
  const std::size_t parts = result.plan.assembly.parts.size(), left = result.plan.remaining.size();
  const std::string words = status == kInterrupted    ? "interrupted"
                            : status == kPluginFailed ? "error"
                                                      : result_word(result.plan);
  nlohmann::ordered_json reason = reason_of(result.plan);
  if (status == kInterrupted || status == kPluginFailed) reason = status == kInterrupted ? "interrupted" : "plugin_failed";
  nlohmann::ordered_json out = {{"status", words},
                                {"reason", std::move(reason)},
                                {"asked", asked_json(result.plan.asked)},
                                {"parts", parts},
                                {"steps", result.plan.disassembly.size()},
                                {"forced", result.plan.forced_steps()},
                                {"accepted", accepted_steps(result.plan)},
                                {"removed", parts - left},
                                {"left", left},
                                {"excluded", result.plan.assembly.excluded.size()},
                                {"unusable", unusable_parts(result.plan)},
                                {"unsolved", result.plan.unsolved.size()},
                                {"assembly", std::string(to_string(result.plan.assembly_status))},
                                {"counters", counters_json(result)},
                                {"plan", plan.string()}};
  if (status == kPluginFailed) out["message"] = "a plugin failed; see 'unsolved' in the plan";
  return out;
}

std::string effort_text(const RunResult& result, bool verbose) {
  std::string text =
      fmt::format("{:.1f} s of preparing, {:.1f} s of planning", result.prepare_seconds, result.plan_seconds);
  if (result.proof_seconds >= 0.05) text += fmt::format(", {:.1f} s of proofs", result.proof_seconds);
  text += fmt::format("; {} {}", result.counts.attempts, result.counts.attempts == 1 ? "path search" : "path searches");
  if (verbose) {
    text += fmt::format("; counters: {} remembered, {} proposed, {} refused", result.counts.memoised,
                        result.counts.proposed, result.counts.refused);
    for (const auto& [name, count] : result.sequence_counts) text += fmt::format(", {} {}", count, name);
  }
  return text + "\n";
}

}  // namespace dismantle::app
