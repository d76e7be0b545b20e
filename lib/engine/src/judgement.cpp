#include "dismantle/engine/judgement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "dismantle/part_set.h"
#include "dismantle/plan_io/plan_file.h"
#include "to_plan.h"

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

/// Questions about operations, each with the one before it.
class Questions {
 public:
  explicit Questions(const std::deque<Operation>& operations) {
    for (const Operation& operation : operations) alone_.push_back(operation.question());
    for (std::size_t k = 0; k < operations.size(); ++k)
      all_.push_back(operations[k].question(k == 0 ? nullptr : &alone_[k - 1]));
  }
  const StepQuestion& operator[](std::size_t k) const { return all_[k]; }
  const std::deque<StepQuestion>& all() const { return all_; }

 private:
  std::deque<StepQuestion> alone_, all_;
};

struct Judged {
  std::vector<PlanVerdict> steps;  ///< in the order of disassembly
  std::optional<PlanVerdict> plan{};
};

Judged judge_with(const StepCheck& check, const PlanObjectiveItem& item, const Questions& questions,
                  const Assembly& assembly, const RunContext& context) {
  Judged judged;
  for (std::size_t k = questions.all().size(); k-- > 0;)
    judged.steps.push_back(verdict_of(item, assembly, [&] { return check.judge(questions[k], context); }));
  if (check.traits().judges_plan) {
    const std::vector<StepQuestion> all(questions.all().begin(), questions.all().end());
    judged.plan = verdict_of(item, assembly, [&] { return check.judge_plan(all, context); });
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
  std::vector<PartId> present;
  for (PartId id = 0; id < disassembly.parts(); ++id)
    if (disassembly.group(id, k) == disassembly.left_group(k) && !contains(step.parts, id)) present.push_back(id);
  return {assembly, disassembly.placed(step.parts, k), disassembly.placed(present, k), *step.path, step.up.value_or(up)};
}

std::deque<Operation> operations_of(const Disassembly& disassembly, const Assembly& assembly,
                                    const Eigen::Vector3d& up) {
  std::deque<Operation> operations;
  for (std::size_t k = disassembly.steps().size(); k-- > 0;)
    operations.push_back(operation_of(disassembly, k, assembly, up));
  return operations;
}

void judge(Plan& plan, const Disassembly& disassembly, const Assembly& assembly, const Objective& objective,
           const RunContext& context) {
  if (objective.empty()) return;
  const std::deque<Operation> operations = operations_of(disassembly, assembly, objective.up);
  const Questions questions(operations);
  PlanObjective& stated = plan.objective;
  stated.up = objective.up;
  for (const ObjectiveItem& item : objective.items) {
    PlanObjectiveItem& check = stated.checks.emplace_back();
    check.type = item.id;
    check.weight = item.weight;
    check.require = item.require;
    check.parameters = item.parameters;
    Judged judged = judge_with(*item.check, check, questions, assembly, context);
    std::string failed = judged.plan ? judged.plan->failed : "";
    for (std::size_t k = 0; k < judged.steps.size(); ++k) {
      if (!judged.steps[k].failed.empty()) failed = judged.steps[k].failed;
      plan.disassembly.at(k).checks.push_back(std::move(judged.steps[k]));
    }
    if (!failed.empty())
      context.log(LogLevel::error, fmt::format("step check '{}' could not judge all steps: {}", item.id, failed));
    check.plan = std::move(judged.plan);
    check.cost = total(plan, stated.checks.size() - 1);
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
  const std::deque<Operation> operations = operations_of(disassembly_of(plan, assembly), assembly, stated.up);
  const Questions questions(operations);
  double cost = 0;
  for (std::size_t c = 0; c < stated.checks.size(); ++c) {
    const PlanObjectiveItem& item = stated.checks[c];
    cost += item.weight * item.cost;
    if (!near(item.cost, total(plan, c)))
      problem(0, fmt::format("objective: '{}' costs {:.6g} in all, not {:.6g} as its verdicts say", item.type,
                             item.cost, total(plan, c)));
    std::shared_ptr<const StepCheck> made;
    try {
      made = check_of_type(item.type, item.parameters);
    } catch (const std::exception& e) {
      check.not_checked.push_back(fmt::format("'{}': {}", item.type, e.what()));
      continue;
    }
    const Judged judged = judge_with(*made, item, questions, assembly, context);
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
