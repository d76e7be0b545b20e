#include "dismantle/verification/check_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "certificates/checker.h"
#include "plan/check_certificates.h"
#include "plan/depth_statements.h"
#include "plan/plan_state.h"
#include "plan/violation_text.h"

namespace dismantle {
namespace {

using Group = std::vector<PartId>;

bool contains(const Group& group, PartId id) { return std::find(group.begin(), group.end(), id) != group.end(); }

Group without(const Group& group, const Group& taken) {
  Group rest;
  for (const PartId id : group)
    if (!contains(taken, id)) rest.push_back(id);
  return rest;
}

class Checker {
 public:
  Checker(const Plan& plan, const Assembly& assembly, const VerifyOptions& options, RunContext& context,
          const ProverOfKind& prover_of)
      : plan_(plan),
        assembly_(assembly),
        context_(context),
        prover_of_(prover_of),
        verifier_(assembly, options),
        state_(assembly),
        depths_(assembly, verifier_, state_, context_) {}

  PlanCheck run() {
    check_names();
    result_.step_penetration.assign(plan_.disassembly.size(), 0);
    result_.forced_depth.assign(plan_.disassembly.size(), 0);
    passed_.resize(plan_.disassembly.size());
    places_then_.resize(plan_.disassembly.size());
    const std::size_t total = plan_.disassembly.size() + plan_.assembly_steps.size();
    std::size_t done = 0;
    for (std::size_t i = 0; i < plan_.disassembly.size() && !stopped(); ++i) {
      step_ = static_cast<unsigned>(i) + 1;
      context_.progress("verify", done++, total, title(plan_.disassembly[i]));
      disassembly_step(plan_.disassembly[i], i);
    }
    const bool complete = state_.does(plan_.asked);
    check_end(complete);
    check_certificates();
    if (!stopped()) assembly_steps(done, total);
    step_ = 0;
    if (stopped()) problem("the check was stopped before its end");
    context_.progress("verify", total, total);
    result_.valid = result_.problems.empty();
    result_.complete = result_.valid && complete && result_.forced == result_.accepted;
    for (const double p : result_.step_penetration) result_.max_penetration = std::max(result_.max_penetration, p);
    return std::move(result_);
  }

 private:
  bool stopped() const { return context_.should_stop(); }
  void problem(std::string message) {
    PlanProblem& p = result_.problems.emplace_back();
    p.step = step_;
    p.message = std::move(message);
  }
  static std::string title(const PlanStep& step) { return step.moves.empty() ? "" : step.moves.front().part; }

  void check_names() {
    std::set<std::string> names;
    for (const auto& part : plan_.assembly.parts) {
      if (!state_.find(part.name)) problem(fmt::format("part '{}' of the plan is not in the assembly", part.name));
      if (!names.insert(part.name).second) problem(fmt::format("part '{}' is listed twice", part.name));
    }
    for (const auto& part : assembly_.parts)
      if (!names.contains(part.name)) problem(fmt::format("part '{}' of the assembly is not in the plan", part.name));
    note("", depths_.wrong_flexible(plan_.assembly));
  }

  std::optional<StepMotion> read(const PlanStep& step, const char* what) {
    std::vector<std::string> found;
    auto motion = state_.read(step.moves, found);
    for (auto& text : found) problem(what + std::move(text));
    return motion;
  }

  /// Checks rule (b). Returns true when it holds.
  bool motion_holds(const StepMotion& motion, const Group& others, const char* what, double& bound) {
    std::vector<PlacedPart> fixed;
    for (const PartId id : others) fixed.push_back({id, state_.place[id]});
    const MotionCheck check = verifier_.check_motion(motion.moving, fixed, motion.path, context_);
    if (check.valid) {
      bound = check.max_penetration;
      return true;
    }
    if (check.interrupted) return false;  // run() reports it
    problem(what + violation_text(check.violation.value_or(Violation{}), assembly_));
    return false;
  }

  void note(const char* what, const std::optional<std::string>& wrong) {
    if (wrong) problem(what + *wrong);
  }

  void disassembly_step(const PlanStep& step, std::size_t index) {
    if (step.step != index + 1) problem(fmt::format("it is numbered {}, expected {}", step.step, index + 1));
    const auto motion = read(step, "");
    if (!motion) return;
    motions_.push_back(*motion);
    for (std::size_t i = 0; i < motion->moving.size(); ++i)
      if (const auto wrong = state_.wrong_start(motion->moving[i], motion->path.front()[i])) problem(*wrong);
    const auto group = std::find_if(state_.groups.begin(), state_.groups.end(), [&](const Group& g) {
      return std::all_of(motion->moving.begin(), motion->moving.end(), [&](PartId id) { return contains(g, id); });
    });
    if (group == state_.groups.end()) {
      problem("it moves parts that do not belong together any more");
    } else {
      passed_[index] = without(*group, motion->moving);
      bool holds = false;
      places_then_[index] = state_.place;
      if (step.forced) {
        ++result_.forced;
        note("", depths_.wrong(*step.forced, *motion, placed(passed_[index]), result_.forced_depth[index]));
        note("", depths_.wrong_valid_to(step, *motion, placed(passed_[index])));
        if (!step.forced->accepted.empty()) accepted_holds(*step.forced, *motion, index);
      } else {
        holds = motion_holds(*motion, passed_[index], "", result_.step_penetration[index]);
      }
      for (const PlanStepOverlap& o : step.overlaps)
        note("", depths_.wrong(o, *motion, holds ? passed_[index] : Group{}));
    }
    for (std::size_t i = 0; i < motion->moving.size(); ++i) state_.place[motion->moving[i]] = motion->path.back()[i];
    if (group != state_.groups.end()) separate_groups(step, static_cast<std::size_t>(group - state_.groups.begin()));
  }

  /// An accepted forced step is valid for all pairs but the one that it names.
  void accepted_holds(const PlanForced& said, const StepMotion& motion, std::size_t index) {
    ++result_.accepted;
    Group others = passed_[index];
    if (const auto other = state_.find(said.other)) others = without(others, {*other});
    motion_holds(motion, others, "beside what is accepted: ", result_.step_penetration[index]);
  }

  std::vector<PlacedPart> placed(const Group& group) const {
    std::vector<PlacedPart> parts;
    for (const PartId id : group) parts.push_back({id, state_.place[id]});
    return parts;
  }

  std::string names(const Group& group) const {
    std::string text;
    for (const PartId id : group) text += (text.empty() ? "'" : ", '") + state_.name(id) + "'";
    return text;
  }

  /// Checks rule (c): what a step separates is apart from the rest of its group and from other separated parts.
  void separate_groups(const PlanStep& step, std::size_t index) {
    Group rest = state_.groups[index];
    std::vector<Group> out;
    for (const auto& list : step.separates) {
      Group part_group;
      for (const auto& name : list) {
        const auto id = state_.find(name);
        if (!id)
          problem(fmt::format("separates '{}', which is not in the assembly", name));
        else if (!contains(rest, *id) || contains(part_group, *id))
          problem(fmt::format("separates '{}', which is not in the group any more", name));
        else
          part_group.push_back(*id);
      }
      if (part_group.empty()) {
        if (list.empty()) problem("separates a group without parts");
        continue;
      }
      rest = without(rest, part_group);
      out.push_back(std::move(part_group));
    }
    if (out.empty()) return;
    if (rest.empty() && out.size() == 1) {
      problem("separates a whole group from nothing");
      return;
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (!rest.empty() && !verifier_.apart(placed(out[i]), placed(rest)))
        problem(fmt::format("{} is not out: its hull meets that of the rest of its group", names(out[i])));
      for (std::size_t k = i + 1; k < out.size(); ++k)
        if (!verifier_.apart(placed(out[i]), placed(out[k])))
          problem(fmt::format("{} and {} are not apart: their hulls meet", names(out[i]), names(out[k])));
    }
    if (rest.empty()) {
      rest = std::move(out.back());
      out.pop_back();
    }
    state_.groups[index] = std::move(rest);
    for (auto& g : out) state_.groups.push_back(std::move(g));
  }

  void check_end(bool complete) {
    step_ = 0;
    const bool forced = result_.forced > result_.accepted;
    if (plan_.status == PlanStatus::complete && forced)
      problem("the plan says that it is complete, but some steps are forced and not accepted");
    if (plan_.status == PlanStatus::forced && (!complete || !forced))
      problem("the plan says that it is forced, but no step is, or some groups have several parts left");
    if (plan_.status == PlanStatus::complete && !complete)
      problem("the plan says that it is complete, but some groups have several parts left");
    std::set<std::string> seen;
    for (const auto& name : plan_.remaining)
      if (!state_.find(name) || !seen.insert(name).second)
        problem(fmt::format("remaining: '{}' is unknown or listed twice", name));
  }

  void check_certificates() {
    if (stopped()) return;
    const auto found = check_certificates_of(plan_, assembly_, verifier_, state_, motions_, prover_of_, context_);
    if (found.problems.empty()) {
      const std::size_t unknown = found.not_checked.size();
      const auto by_provers =
          std::count_if(plan_.certificates.begin(), plan_.certificates.end(),
                        [](const PlanCertificate& c) { return certificates::checker_of(c.kind) == nullptr; });
      result_.certificates = plan_.certificates.size() - unknown;
      result_.checked_by_prover = static_cast<std::size_t>(by_provers) - unknown;
    }
    for (const auto& text : found.problems) problem(text);
    result_.not_checked.insert(result_.not_checked.end(), found.not_checked.begin(), found.not_checked.end());
  }

  /// Distance within which two poses count as equal, assembly units. Covers the rounding of numbers written with twelve
  /// or more digits. Far below the resolution of a path check.
  double rounding() const { return 1e-3 * state_.tolerance(); }

  /// True if `back`, from its pose `transfer` on, is the checked step `index` backwards. Poses are compared as motions:
  /// q and -q are one rotation, and no corner of the part's box may be off by more than rounding(). The certified
  /// penetration plus what this difference may add must be within the tolerance.
  bool is_reverse(std::size_t index, const PlanStep& back) const {
    std::vector<std::string> found;
    const auto a = state_.read(plan_.disassembly[index].moves, found), b = state_.read(back.moves, found);
    if (!a || !b || a->path.size() + back.transfer != b->path.size() || a->moving.size() != b->moving.size())
      return false;
    const std::size_t last = b->path.size() - 1;
    double most = 0;
    for (std::size_t i = 0; i < a->moving.size(); ++i) {
      const auto at = std::find(b->moving.begin(), b->moving.end(), a->moving[i]);
      if (at == b->moving.end()) return false;
      const auto k = static_cast<std::size_t>(at - b->moving.begin());
      for (std::size_t n = 0; n < a->path.size(); ++n)
        most = std::max(most, state_.offset(a->moving[i], a->path[n][i], b->path[last - n][k]));
    }
    return most <= rounding() && result_.step_penetration[index] + 2 * most <= verifier_.options().max_penetration;
  }

  /// Algorithm 3: each part comes from the layout, or from any pose if there is no layout. Moving parts are checked
  /// against all other parts: those in place, and those that are still in the layout.
  void assembly_steps(std::size_t done, std::size_t total) {
    claims();
    if (plan_.assembly_steps.empty()) return;
    const bool disassembly_holds = result_.problems.empty();
    state_ = PlanState(assembly_);
    std::vector<bool> present(assembly_.parts.size(), true);
    for (auto step = plan_.assembly_steps.rbegin(); step != plan_.assembly_steps.rend(); ++step)
      for (const auto& move : step->moves)
        if (const auto id = state_.find(move.part); id && !move.poses.empty()) {
          const Pose& first = move.poses.front();
          state_.place[*id] = assembly_.normalization.pose_to_internal({first.t, first.q.normalized()});
          // A part that is only shifted back is present from the beginning, unless an earlier step brings it.
          present[*id] =
              step->transfer > 0 || stays(static_cast<std::size_t>(plan_.assembly_steps.rend() - step) - 1, move.part);
        }

    const std::size_t count = plan_.assembly_steps.size();
    for (std::size_t i = 0; i < count && !stopped(); ++i) {
      const PlanStep& step = plan_.assembly_steps[i];
      step_ = static_cast<unsigned>(i) + 1;
      context_.progress("verify", done++, total, title(step));
      const auto motion = read(step, kWhat);
      if (!motion) continue;
      for (std::size_t k = 0; k < motion->moving.size(); ++k)
        if (const auto wrong = state_.wrong_start(motion->moving[k], motion->path.front()[k])) problem(kWhat + *wrong);
      Group others;
      for (PartId id = 0; id < present.size(); ++id)
        if (present[id] && !contains(motion->moving, id)) others.push_back(id);
      if (step.transfer >= motion->path.size())
        problem(fmt::format("{}its transfer ends beyond its poses", kWhat));
      else
        check_motion_of(*motion, others, step,
                        disassembly_holds && count == plan_.disassembly.size() ? count - 1 - i : count);
      for (std::size_t k = 0; k < motion->moving.size(); ++k) {
        state_.place[motion->moving[k]] = motion->path.back()[k];
        present[motion->moving[k]] = true;
      }
    }
    step_ = 0;
    if (stopped()) return;
    for (PartId id = 1; id < state_.place.size(); ++id)
      if (state_.offset(id, state_.place[id], state_.place[0]) > state_.tolerance())
        problem(fmt::format("after the assembly steps '{}' is not in its place beside '{}'", state_.name(id),
                            state_.name(0)));
  }

  /// `there`: index of the disassembly step that this one may reverse; beyond the last if there is none.
  void check_motion_of(const StepMotion& motion, const Group& others, const PlanStep& step, std::size_t there) {
    double bound = 0;
    const bool reverse = there < plan_.disassembly.size() && is_reverse(there, step);
    const bool forced = there < plan_.disassembly.size() && plan_.disassembly[there].forced.has_value();
    if (!reverse && !forced) {
      motion_holds(motion, others, kWhat, bound);
      return;
    }
    // The reverse of a checked step needs no second check against the parts that the step passed: the relative motion
    // is the same.
    const auto at = motion.path.begin() + static_cast<std::ptrdiff_t>(step.transfer);
    if (step.transfer > 0 && !motion_holds({motion.moving, {motion.path.begin(), at + 1}}, others, kWhat, bound))
      return;
    const Group unmet = without(without(others, passed_[there]), gone_then(there, others));
    if (!unmet.empty()) motion_holds({motion.moving, {at, motion.path.end()}}, unmet, kWhat, bound);
    double measured = 0;
    if (!reverse)
      note(kWhat, depths_.wrong(*plan_.disassembly[there].forced, {motion.moving, {at, motion.path.end()}},
                                placed(without(others, unmet)), measured));
  }

  /// Parts of `others` that were separated before disassembly step `index` and are still at the same place. The
  /// disassembly passed them without a check, so its exact reverse does too.
  Group gone_then(std::size_t index, const Group& others) const {
    Group gone;
    if (plan_.assembly_status != AssemblyStatus::reversed) return gone;
    for (const PartId id : others)
      if (!contains(passed_[index], id) && state_.offset(id, state_.place[id], places_then_[index][id]) <= rounding())
        gone.push_back(id);
    return gone;
  }

  /// True when assembly step `index` is a disassembly step backwards that separated nothing.
  bool only_shifts(std::size_t index) const {
    const std::size_t count = plan_.disassembly.size();
    return plan_.assembly_steps.size() == count && plan_.disassembly[count - 1 - index].separates.empty();
  }

  /// True also if that step moved `part` and separated only others of the parts that it moved.
  bool stays(std::size_t index, const std::string& part) const {
    if (only_shifts(index)) return true;
    const std::size_t count = plan_.disassembly.size();
    if (plan_.assembly_steps.size() != count) return false;
    const PlanStep& there = plan_.disassembly[count - 1 - index];
    const auto separated = [&](const std::string& name) {
      return std::any_of(there.separates.begin(), there.separates.end(),
                         [&](const auto& group) { return std::find(group.begin(), group.end(), name) != group.end(); });
    };
    return !separated(part) && std::any_of(there.moves.begin(), there.moves.end(),
                                           [&](const PlanMove& move) { return separated(move.part); });
  }

  /// A plan that calls its assembly complete must bring every removed part from the layout.
  void claims() {
    if (plan_.assembly_status != AssemblyStatus::complete) return;
    std::set<std::string> brought;
    for (std::size_t i = 0; i < plan_.assembly_steps.size(); ++i) {
      const PlanStep& step = plan_.assembly_steps[i];
      if (step.transfer == 0 && !only_shifts(i))
        problem(fmt::format("the plan calls its assembly complete, but assembly step {} does not begin in the layout",
                            step.step));
      for (const auto& move : step.moves) brought.insert(move.part);
    }
    for (const auto& step : plan_.disassembly)
      for (const auto& move : step.moves)
        if (brought.insert(move.part).second)
          problem(fmt::format("the plan calls its assembly complete, but has no assembly step for '{}'", move.part));
  }

  static constexpr const char* kWhat = "assembly step: ";
  const Plan& plan_;
  const Assembly& assembly_;
  RunContext& context_;
  const ProverOfKind& prover_of_;
  Verifier verifier_;
  PlanState state_;
  DepthStatements depths_;
  PlanCheck result_;
  std::vector<StepMotion> motions_;             // of the disassembly steps that could be read
  std::vector<Group> passed_;                   // by disassembly step: the parts that it was checked against, ...
  std::vector<std::vector<Pose>> places_then_;  // ... and the poses of all parts
  unsigned step_ = 0;
};

}  // namespace

PlanCheck check_plan(const Plan& plan, const Assembly& assembly, const VerifyOptions& options, RunContext& context,
                     const ProverOfKind& prover_of) {
  return Checker(plan, assembly, options, context, prover_of).run();
}

}  // namespace dismantle
