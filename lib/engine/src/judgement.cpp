#include "dismantle/engine/judgement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <exception>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "dismantle/executor.h"
#include "dismantle/part_set.h"
#include "dismantle/plan_io/plan_file.h"
#include "to_plan.h"
#include "whole_plan.h"

namespace dismantle {

namespace {

/// Why a verdict cannot be written; empty: it can.
std::string objection_to(const StepVerdict& verdict) {
  if (!(verdict.cost >= 0) || !std::isfinite(verdict.cost)) return "its cost is not a number from 0 on";
  for (const StepNote& note : verdict.notes) {
    if (note.kind.empty()) return "a note has no kind";
    if (!note.data.empty() && !is_json_object(note.data))
      return fmt::format("the data of the note '{}' is not a JSON object", note.kind);
  }
  return "";
}

/// The verdict that `ask` returns; `failed` when it does not return one that can be written.
PlanVerdict verdict_of(const PlanObjectiveItem& item, const Assembly& assembly,
                       const std::function<StepVerdict()>& ask) {
  PlanVerdict written;
  written.type = item.type;
  written.weight = item.weight;
  try {
    StepVerdict verdict = ask();
    written.failed = objection_to(verdict);
    if (!written.failed.empty()) return written;
    written.cost = verdict.cost;
    written.allowed = verdict.allowed;
    written.reason = std::move(verdict.reason);
    written.notes = std::move(verdict.notes);
    if (verdict.certificate) written.certificate = to_plan(*verdict.certificate, assembly);
  } catch (const std::exception& e) {
    written.failed = e.what();
    if (written.failed.empty()) written.failed = "it threw an exception without a text";
  }
  return written;
}

/// What some checks say of a plan.
struct Judged {
  std::vector<PlanVerdict> steps;  ///< in the order of disassembly
  std::optional<PlanVerdict> plan{};
};

/// A check to ask, and how it stands in the plan.
struct Asked {
  const StepCheck& check;
  const PlanObjectiveItem& item;
};

/// The parts that are present at each step, from the last step to the first: only those that move are looked at.
class Present {
 public:
  explicit Present(const Disassembly& done) : done_(done), lists_(done.groups().size()) {}
  /// Operation of step `k`, which is one less than at the call before.
  Operation operation(std::size_t k, const Assembly& assembly, const Eigen::Vector3d& up) {
    const DisassemblyStep& step = done_.steps()[k];
    std::optional<std::vector<PlacedPart>>& list = lists_[done_.left_group(k)];
    if (!list) list = done_.placed(done_.groups()[done_.left_group(k)]);
    std::erase_if(*list, [&](const PlacedPart& p) { return contains(step.parts, p.part); });  // that stay, elsewhere
    const std::vector<PlacedPart> moved = done_.placed(step.parts, k);
    Operation operation(assembly, moved, *list, *step.path, step.up.value_or(up));
    std::vector<PlacedPart> with;
    with.reserve(list->size() + moved.size());
    std::merge(list->begin(), list->end(), moved.begin(), moved.end(), std::back_inserter(with),
               [](const PlacedPart& a, const PlacedPart& b) { return a.part < b.part; });
    *list = std::move(with);
    return operation;
  }

 private:
  const Disassembly& done_;
  std::vector<std::optional<std::vector<PlacedPart>>> lists_;  // by group; ascending
};

/// The steps are judged on all threads of the run, some operations at a time: each holds all parts that are present.
std::vector<Judged> judge_with(const std::vector<Asked>& checks, const Disassembly& done, const Assembly& assembly,
                               const Eigen::Vector3d& up, const RunContext& context) {
  constexpr std::size_t kAtOnce = 64;
  const std::size_t count = done.steps().size();
  std::vector<Judged> judged(checks.size());
  for (Judged& j : judged) j.steps.resize(count);
  std::optional<Operation> before;
  Present present(done);
  for (std::size_t end = count; end > 0;) {
    const std::size_t begin = end - std::min(end, kAtOnce);
    std::deque<Operation> operations;  // in the order of assembly: of step end - 1, ..., begin
    for (std::size_t k = end; k-- > begin;) operations.push_back(present.operation(k, assembly, up));
    const auto previous = [&](std::size_t i) {
      if (i > 0) return std::optional(operations[i - 1].question());
      return before ? std::optional(before->question()) : std::nullopt;
    };
    const auto judge_operation = [&](std::size_t i) {
      const std::optional<StepQuestion> earlier = previous(i);
      const StepQuestion question = operations[i].question(earlier ? &*earlier : nullptr);
      for (std::size_t c = 0; c < checks.size(); ++c)
        judged[c].steps[end - 1 - i] =
            verdict_of(checks[c].item, assembly, [&] { return checks[c].check.judge(question, context); });
    };
    parallel_for(operations.size(), context, judge_operation, [] { return false; });
    before.emplace(std::move(operations.back()));
    end = begin;
  }
  std::optional<WholePlan> whole;
  for (std::size_t c = 0; c < checks.size(); ++c) {
    if (!checks[c].check.traits().judges_plan) continue;
    if (!whole) whole.emplace(done, assembly, up);
    judged[c].plan =
        verdict_of(checks[c].item, assembly, [&] { return checks[c].check.judge_plan(whole->all(), context); });
  }
  return judged;
}

/// The cost of a check over the steps of a plan and the plan as a whole.
double total(const Plan& plan, std::size_t check) {
  const auto& whole = plan.objective.checks[check].plan;
  double sum = whole ? whole->cost : 0;
  for (const PlanStep& step : plan.disassembly) sum += step.checks.at(check).cost;
  return sum;
}

bool near(double a, double b) { return std::abs(a - b) <= 1e-6 * (1 + std::abs(a)); }

/// How the verdict differs from that of the plan; empty: it does not. The input's numbers are rounded in the plan.
std::string difference(const PlanVerdict& stated, const PlanVerdict& now) {
  if (!now.failed.empty() && stated.failed.empty()) return fmt::format("the check fails now: {}", now.failed);
  if (!stated.failed.empty() && now.failed.empty()) return "the plan says that the check failed, and it does not";
  if (stated.allowed != now.allowed)
    return fmt::format("the plan says {}, the check says {}{}", stated.allowed ? "allowed" : "not allowed",
                       now.allowed ? "allowed" : "not allowed", now.reason.empty() ? "" : ": " + now.reason);
  if (!near(stated.cost, now.cost))
    return fmt::format("the plan says that it costs {:.6g}, the check says {:.6g}", stated.cost, now.cost);
  return "";
}

}  // namespace

Operation operation_of(const Disassembly& disassembly, std::size_t k, const Assembly& assembly,
                       const Eigen::Vector3d& up) {
  const DisassemblyStep& step = disassembly.steps().at(k);
  const std::size_t group = disassembly.left_group(k);
  std::vector<PlacedPart> present;
  for (PartId id = 0; id < disassembly.parts(); ++id)
    if (disassembly.group(id, k) == group && !contains(step.parts, id))
      present.push_back({id, disassembly.pose(id, k)});
  return {assembly, disassembly.placed(step.parts, k), std::move(present), *step.path, step.up.value_or(up)};
}

bool prefers_orders(const Objective& objective) {
  return std::ranges::any_of(objective.items, [](const ObjectiveItem& i) { return i.require || i.weight > 0; });
}

void judge(Plan& plan, const Disassembly& disassembly, const Assembly& assembly, const Objective& objective,
           const RunContext& context) {
  if (objective.empty()) return;
  PlanObjective& stated = plan.objective;
  stated.up = objective.up;
  for (const ObjectiveItem& item : objective.items) {
    PlanObjectiveItem& check = stated.checks.emplace_back();
    check.type = item.id;
    check.weight = item.weight;
    check.require = item.require;
    check.parameters = item.parameters;
  }
  std::vector<Asked> asked;
  for (std::size_t c = 0; c < stated.checks.size(); ++c) asked.push_back({*objective.items[c].check, stated.checks[c]});
  std::vector<Judged> all = judge_with(asked, disassembly, assembly, objective.up, context);
  for (std::size_t c = 0; c < stated.checks.size(); ++c) {
    PlanObjectiveItem& check = stated.checks[c];
    Judged& judged = all[c];
    std::string failed = judged.plan ? judged.plan->failed : "";
    for (std::size_t k = 0; k < judged.steps.size(); ++k) {
      if (!judged.steps[k].failed.empty()) failed = judged.steps[k].failed;
      plan.disassembly.at(k).checks.push_back(std::move(judged.steps[k]));
    }
    if (!failed.empty())
      context.log(LogLevel::error, fmt::format("step check '{}' could not judge all steps: {}", check.type, failed));
    check.plan = std::move(judged.plan);
    check.cost = total(plan, c);
    stated.cost += check.weight * check.cost;
  }
}

void judge_again(PlanCheck& check, const Plan& plan, const Assembly& assembly, const CheckOfType& check_of_type,
                 const RunContext& context) {
  if (!check.valid) return;
  const auto problem = [&](unsigned step, std::string text) {
    check.valid = check.complete = false;
    check.problems.push_back({step, std::move(text)});
  };
  const PlanObjective& stated = plan.objective;
  for (const PlanStep& step : plan.disassembly) {
    const bool same = std::equal(step.checks.begin(), step.checks.end(), stated.checks.begin(), stated.checks.end(),
                                 [](const PlanVerdict& v, const PlanObjectiveItem& item) {
                                   return v.type == item.type && v.weight == item.weight;
                                 });
    if (!same) return problem(step.step, "its checks are not those of the objective");
  }
  if (stated.empty()) return;
  std::vector<std::shared_ptr<const StepCheck>> made;
  std::vector<Asked> asked;
  for (const PlanObjectiveItem& item : stated.checks) {
    std::shared_ptr<const StepCheck>& own = made.emplace_back();
    try {
      own = check_of_type(item.type, item.parameters);
      asked.push_back({*own, item});
    } catch (const std::exception& e) {
      check.not_checked.push_back(fmt::format("'{}': {}", item.type, e.what()));
    }
  }
  const std::vector<Judged> all = judge_with(asked, disassembly_of(plan, assembly), assembly, stated.up, context);
  double cost = 0;
  std::size_t next = 0;
  for (std::size_t c = 0; c < stated.checks.size(); ++c) {
    const PlanObjectiveItem& item = stated.checks[c];
    cost += item.weight * item.cost;
    if (!near(item.cost, total(plan, c)))
      problem(0, fmt::format("objective: '{}' costs {:.6g} in all, not {:.6g} as its verdicts say", item.type,
                             item.cost, total(plan, c)));
    if (!made[c]) continue;
    const Judged& judged = all[next++];
    for (std::size_t k = 0; k < judged.steps.size(); ++k, ++check.verdicts)
      if (const auto text = difference(plan.disassembly[k].checks[c], judged.steps[k]); !text.empty())
        problem(plan.disassembly[k].step, fmt::format("'{}': {}", item.type, text));
    if (item.plan.has_value() != judged.plan.has_value())
      problem(0, fmt::format("objective: '{}' judges {}, which the plan does not say", item.type,
                             judged.plan ? "the plan as a whole" : "steps only"));
    else if (judged.plan)
      if (const auto text = difference(*item.plan, *judged.plan); !text.empty())
        problem(0, fmt::format("objective: '{}': {}", item.type, text));
  }
  if (!near(stated.cost, cost)) problem(0, fmt::format("objective: the sum is {:.6g}, not {:.6g}", cost, stated.cost));
}

}  // namespace dismantle
