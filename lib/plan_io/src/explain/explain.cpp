#include "dismantle/plan_io/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "dismantle/errors.h"
#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/plan_history.h"
#include "dismantle/plan_io/thread_words.h"
#include "explain/advice.h"
#include "explain/reach.h"

namespace dismantle {
namespace {

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

LeftPart left_part(const Plan& plan, const PlanHistory& history, const PlanUnsolved& u) {
  LeftPart out;
  out.part = u.part;
  out.best_pose = u.best_pose;
  const Pose last = history.pose_of(history.index_of(u.part), history.steps());
  const Reach reach = reach_of(plan, last, u.best_pose, plan.assembly.center);
  out.moved = reach.moved;
  out.travel = reach.travel;
  out.turn = reach.turn;
  out.planner = u.planner;
  out.attempts = u.attempts;
  out.depth = u.depth;
  out.seconds = u.seconds;
  out.message = u.message;
  const auto blocker = [&](const std::string& name) -> Blocker& {
    const auto known = std::ranges::find(out.blockers, name, &Blocker::part);
    return known != out.blockers.end() ? *known : out.blockers.emplace_back(Blocker{name, {}, 0});
  };
  for (const std::string& name : u.blocked_by) blocker(name);
  for (const PlanPlace& place : u.places)
    if (u.blocked_by.empty() || has(u.blocked_by, place.part)) blocker(place.part).at = place.at;
  for (const PlanOverlap& o : plan.assembly.overlaps) {
    if (o.a != u.part && o.b != u.part) continue;
    const std::string& other = o.a == u.part ? o.b : o.a;
    if (has(plan.remaining, other) && plan.assembly.scale > 0) blocker(other).overlap = o.depth / plan.assembly.scale;
  }
  return out;
}

/// Groups parts by outcome and proof. Equally large reasons are in the order of their first parts.
std::vector<LeftReason> reasons_of(const Plan& plan, const PlanHistory& history, const ExplainSettings& settings,
                                   const std::string& part) {
  std::vector<LeftReason> out;
  for (const PlanUnsolved& u : plan.unsolved) {
    if (!part.empty() && u.part != part) continue;
    const PlanCertificate* proof =
        u.certificate && *u.certificate < plan.certificates.size() ? &plan.certificates[*u.certificate] : nullptr;
    // The constraints are a reason of their own, whatever the outcome.
    const auto held = [](const std::string& message) { return message.find("constraints") != std::string::npos; };
    const auto same = [&](const LeftReason& r) {
      return r.outcome == u.outcome && r.certificate == proof && held(r.parts.front().message) == held(u.message) &&
             (r.parts.front().attempts == 0) == (u.attempts == 0);
    };
    auto reason = std::ranges::find_if(out, same);
    if (reason == out.end())
      reason = out.insert(out.end(), {u.outcome, meaning_of(u.outcome), {}, proof, u.certificate.value_or(0), {}});
    reason->parts.push_back(left_part(plan, history, u));
  }
  std::ranges::stable_sort(out,
                           [](const LeftReason& a, const LeftReason& b) { return a.parts.size() > b.parts.size(); });
  for (LeftReason& reason : out) reason.advice = advice_on(reason, plan, settings);
  return out;
}

/// The parts that leave in a step, or those that it shifts.
std::vector<std::string> taken_in(const Plan& plan, const PlanHistory& history, std::size_t step) {
  std::vector<std::string> names;
  for (const std::size_t i : history.leaving(step)) names.push_back(plan.assembly.parts[i].name);
  if (names.empty())
    for (const PlanMove& move : plan.disassembly[step].moves) names.push_back(move.part);
  return names;
}

std::vector<StepReason> steps_of(const Plan& plan, const PlanHistory& history, const std::string& part) {
  std::vector<StepReason> out;
  for (const PlanStep& step : plan.disassembly) {
    StepReason reason;
    reason.step = step.step;
    for (const PlanMove& move : step.moves) reason.parts.push_back(move.part);
    if (!part.empty() && !has(reason.parts, part)) continue;
    reason.after = step.after;
    reason.known = step.layer > 0;
    reason.contacts = step.contacts;
    for (const unsigned earlier : step.after)
      if (earlier >= 1 && earlier <= plan.disassembly.size())
        for (std::string& name : taken_in(plan, history, earlier - 1))
          if (!has(reason.waited_for, name)) reason.waited_for.push_back(std::move(name));
    out.push_back(std::move(reason));
  }
  return out;
}

}  // namespace

Reach reach_of(const Plan& plan, const Pose& last, const Pose& best, const Eigen::Vector3d& point) {
  const double size = plan.assembly.box.empty() ? 1 : plan.assembly.box.size().maxCoeff();
  Reach out;
  out.travel = (best * point - last * point).norm();
  out.turn = angle_between(best.q, last.q);
  out.moved = out.travel > 1e-9 * size || out.turn > 1e-5;
  return out;
}

Explanation explain(const Plan& plan, const ExplainSettings& settings, const std::string& part) {
  const auto known = [&](const PlanPart& p) { return p.name == part; };
  if (!part.empty() && std::ranges::none_of(plan.assembly.parts, known))
    throw InputError(plan.assembly.source, fmt::format("the plan has no part '{}'", part));
  const PlanHistory history(plan);
  Explanation out{&plan, steps_of(plan, history, part), reasons_of(plan, history, settings, part), {}};
  if (plan.status != PlanStatus::partial) return out;
  for (const std::string& name : plan.remaining)
    if ((part.empty() || name == part) &&
        std::ranges::none_of(plan.unsolved, [&](const PlanUnsolved& u) { return u.part == name; }))
      out.untried.push_back(name);
  return out;
}

std::string forced_text(const TextUnit& unit, const PlanForced& forced) {
  return fmt::format("{} cuts {}{} into {} ({} when assembled){}", forced.part, forced.lower_bound ? "at least " : "",
                     length_text(unit, forced.depth), forced.other, length_text(unit, forced.assembled),
                     forced.accepted.empty() ? "" : ", accepted as " + forced.accepted);
}

std::string forced_text(const Plan& plan, const PlanForced& forced) { return forced_text(length_unit(plan), forced); }

std::string overlaps_text(const TextUnit& unit, const PlanStep& step) {
  std::string out;
  const auto point = [](const Eigen::Vector3d& p) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x(), p.y(), p.z());
  };
  for (const PlanStepOverlap& o : step.overlaps) {
    out += fmt::format("       {} and {} overlap by {} when assembled, by up to {} along the way", o.part, o.other,
                       length_text(unit, o.assembled), length_text(unit, o.depth));
    if (o.at) out += fmt::format(", at {}", point(*o.at));
    if (o.region)
      out += fmt::format(", and only where they do from {} to {}", point(o.region->lo), point(o.region->hi));
    out += "\n";
  }
  return out;
}

std::string overlaps_text(const Plan& plan, const PlanStep& step) {
  std::string out = overlaps_text(length_unit(plan), step);
  for (const std::string& words : thread_words(plan, step)) out += "       " + words + "\n";
  return out;
}

TextUnit length_unit(const Plan& plan) {
  TextUnit unit = text_unit(plan.assembly.unit, plan.assembly.box);
  if (unit.name.empty()) unit.name = "input units";
  return unit;
}

std::string length_text(const TextUnit& unit, double length) {
  return fmt::format("{} {}", figure_text(length * unit.factor), unit.name);
}

std::string length_text(const Plan& plan, double length) { return length_text(length_unit(plan), length); }

}  // namespace dismantle
