// Planning: prepares, asks the sequence planner, records its removals, and finds out the rest of the plan.
#include "dismantle/engine/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>

#include "acceptance.h"
#include "alternatives.h"
#include "assembler.h"
#include "deferred_simulator.h"
#include "dismantle/engine/judgement.h"
#include "dismantle/errors.h"
#include "dismantle/executor.h"
#include "dismantle/part_set.h"
#include "oracle.h"
#include "precedence.h"
#include "reached.h"
#include "reasons.h"
#include "recorder.h"
#include "replay.h"
#include "requiring_oracle.h"
#include "rng_streams.h"
#include "step_overlaps.h"
#include "stopwatch.h"
#include "to_plan.h"

namespace dismantle {

namespace {

using Clock = std::chrono::steady_clock;

Outcome why_stopped(const RunContext& context) {
  return context.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout;
}

PartId part_named(const Assembly& assembly, const std::string& name) {
  for (const auto& part : assembly.parts)
    if (part.name == name) return part.id;
  std::string names;
  for (const auto& part : assembly.parts) names += (names.empty() ? "'" : ", '") + part.name + "'";
  throw InputError(assembly.source, fmt::format("has no part '{}'; its parts are {}", name, names));
}

void check(const Assembly& assembly, const PlanningSetup& setup, const RunOptions& options) {
  if (assembly.parts.empty()) throw InputError(assembly.source, "has no parts");
  for (std::size_t i = 0; i < assembly.parts.size(); ++i)
    if (assembly.parts[i].id != i || !assembly.parts[i].mesh)
      throw std::invalid_argument("parts of an assembly are numbered by their place and have meshes");
  if (!setup.simulator) throw std::invalid_argument("no simulator given");
  if (!setup.path_planner) throw std::invalid_argument("no path planner given");
  if (setup.transfer_planner && options.layout.enabled)
    for (const auto& entry : options.layout.poses) part_named(assembly, entry.first);
  if (!options.only_part.empty()) return;
  if (!setup.sequence_planner) throw std::invalid_argument("no sequence planner given");
  const SequencePlannerTraits traits = setup.sequence_planner->traits();
  if (!options.constraints.empty() && !traits.keeps_constraints)
    throw std::invalid_argument("there are constraints, and the sequence planner does not say that it keeps them");
  if ((options.resume || !options.start.empty()) && !traits.any_start)
    throw std::invalid_argument("the sequence planner does not say that it starts from any arrangement of the parts");
  if (options.resume && !options.start.empty()) throw std::invalid_argument("a run has one start");
}

SequenceResult plan_sequence(const SequenceQuery& query, SequencePlanner& planner, PathOracle& oracle,
                             Recorder& recorder, const RunContext& context) {
  RunContext own = context;
  own.rng = context.rng.fork(sequence_stream);
  SequenceResult result;
  std::string problem;
  try {
    result = planner.plan(query, oracle, recorder, own);
    problem = recorder.problem();
  } catch (const std::exception& e) {
    problem = e.what();
  } catch (...) {
    problem = "it threw something that is not a std::exception";
  }
  if (!problem.empty()) {
    context.log(LogLevel::error, fmt::format("the sequence planner failed: {}", problem));
    result = {};
    result.outcome = Outcome::crashed;
  }
  return result;
}

SequenceResult plan_one(const Assembly& assembly, PartId part, PathOracle& oracle, Recorder& recorder,
                        RunContext context) {
  Attempt attempt{recorder.disassembly().placed(std::vector{part}), recorder.disassembly().around(part)};
  SequenceResult result;
  if (attempt.fixed.empty()) {
    result.outcome = Outcome::start_is_goal;
    return result;
  }
  context.progress("sequence", 0, 1, assembly.parts[part].name);
  const AttemptResult& answer = oracle.attempt(attempt, context);
  result.outcome = answer.result.outcome();
  if (is_success(result.outcome)) {
    result.removals.push_back({{part}, &answer});
    recorder.removed(result.removals.back(), assembly.parts.size() - 1);
    context.progress("sequence", 1, 1, assembly.parts[part].name);
  } else {
    result.unsolved.push_back({part, result.outcome, answer.result.blocked_by, answer.result.best_pose,
                               answer.result.message, answer.certificate});
  }
  return result;
}

/// Contacts of a remaining part with others at its best pose, from the simulator.
ContactsOf contacts_of(const Assembly& assembly, const DeferredSimulator& simulator, const Disassembly& disassembly,
                       const RunContext& context) {
  if (!simulator.capabilities().contacts) return {};
  return [&](PartId part, const Pose& at) {
    std::vector<Contact> deepest;
    if (context.should_stop()) return deepest;
    try {
      const Scene scene{{{part, at}}, disassembly.around(part)};
      const std::unique_ptr<World> world = simulator.world(assembly, PreparedAssembly{}, scene, MotionSpace::rigid);
      std::vector<Contact> all;
      world->contacts(world->initial_state(), all);
      std::ranges::stable_sort(all, [](const Contact& a, const Contact& b) {
        return a.other != b.other ? a.other < b.other : a.depth > b.depth;
      });
      for (const Contact& c : all)
        if (deepest.empty() || deepest.back().other != c.other) deepest.push_back(c);
    } catch (const std::exception& e) {
      context.log(LogLevel::warning,
                  fmt::format("where '{}' is blocked is not known: {}", assembly.parts[part].name, e.what()));
      deepest.clear();
    }
    return deepest;
  };
}

/// One run, from the question to the plan.
class Run {
 public:
  Run(const Assembly& assembly, const PlanningSetup& setup, const RunOptions& options, const RunContext& context,
      const StepObserver& on_step)
      : assembly_(assembly),
        setup_(setup),
        options_(options),
        context_(context),
        simulator_(*setup.simulator, assembly, options.verify.max_penetration, context),
        verifier_(assembly, options.verify, context),
        oracle_(assembly, nothing_, setup, &simulator_, options, verifier_, context),
        recorder_(assembly, oracle_, setup, options, on_step, context) {}

  RunResult operator()() {
    const Clock::time_point begin = Clock::now();
    plan_steps();
    simulator_.rethrow_failure();
    if (simulator_.was_stopped()) sequence_.outcome = why_stopped(context_);
    RunResult result;
    result.plan = plan_of(recorder_.disassembly(), assembly_, options_);
    set_reached(result.plan, recorder_.disassembly(), verifier_, context_);
    mark_accepted(result.plan, recorder_.disassembly(), assembly_, options_.constraints, verifier_, context_);
    result.outcome = sequence_.outcome;
    explain(result);
    complete(result);
    result.disassembly = recorder_.disassembly();
    result.counts = oracle_.counts();
    result.planner_counts = oracle_.planner_counts();
    result.sequence_counts = sequence_.counts;
    simulator_.rethrow_failure();  // failure during a transfer
    result.prepare_seconds = simulator_.seconds();
    result.plan_seconds = seconds_since(begin) - result.prepare_seconds;
    result.proof_seconds = oracle_.proof_seconds();
    return result;
  }

 private:
  bool only_one() const { return !options_.only_part.empty(); }

  void plan_steps() {
    if (options_.resume) replay(*options_.resume, assembly_, options_.constraints, oracle_, recorder_, context_);
    const Objective none{{}, setup_.objective.up};
    const SequenceQuery query{assembly_, open_groups(recorder_.disassembly(), options_.constraints),
                              options_.constraints, prefers_orders(setup_.objective) ? setup_.objective : none};
    if (RequiringOracle::is_needed(setup_.objective))
      requiring_.emplace(assembly_, setup_.objective, recorder_.disassembly(), oracle_);
    PathOracle& asked = requiring_ ? static_cast<PathOracle&>(*requiring_) : oracle_;
    // A run whose time is up still forces steps, in the overtime that is kept for them.
    if (context_.cancel.cancelled() || (context_.should_stop() && oracle_.forcing() == nullptr))
      sequence_.outcome = why_stopped(context_);
    else if (only_one())
      sequence_ = plan_one(assembly_, part_named(assembly_, options_.only_part), asked, recorder_, context_);
    else if (query.start.empty())
      sequence_.outcome = Outcome::solved;
    else
      sequence_ = plan_sequence(query, *setup_.sequence_planner, asked, recorder_, context_);
  }

  /// States why parts are left.
  void explain(RunResult& result) {
    const Disassembly& done = recorder_.disassembly();
    const ContactsOf places = contacts_of(assembly_, simulator_, done, context_);
    std::vector<Unsolved> unsolved = sequence_.unsolved;
    if (!only_one()) {
      const auto left = open_groups(done, options_.constraints);
      if (left.empty()) {
        unsolved.clear();
        if (result.plan.status == PlanStatus::complete) result.outcome = Outcome::solved;
      } else {
        if (is_success(sequence_.outcome)) {
          result.outcome = Outcome::crashed;
          std::size_t together = 0;
          for (const auto& group : left) together += group.size();
          context_.log(LogLevel::error,
                       fmt::format("the sequence planner reports success with {} parts still together", together));
        }
        unsolved = reasons_of(sequence_, left);
        prove_left(unsolved, left, oracle_.proofs(), options_.proofs, context_);
      }
    }
    if (requiring_) requiring_->explain(unsolved);
    set_unsolved(result.plan, unsolved, assembly_, done, oracle_, places);
    if (requiring_)
      for (PlanUnsolved& u : result.plan.unsolved) u.refused_by = requiring_->refused_by(part_named(assembly_, u.part));
    state_proofs(result.plan, sequence_.proofs, assembly_);
  }

  /// Finds what the plan says beyond its steps: their order, their overlaps, and how the assembly is put together.
  void complete(RunResult& result) {
    const Disassembly& done = recorder_.disassembly();
    AssemblyPlan back;
    const bool puts_together = setup_.transfer_planner && options_.layout.enabled && !done.steps().empty();
    const auto put_together = [&] {
      if (!puts_together) return;
      RunContext putting = context_;
      putting.rng = Rng(options_.seed).fork(transfer_stream);
      back = Assembler(assembly_, simulator_, setup_, options_, verifier_)
                 .put_together(done, result.plan.disassembly, putting);
    };
    std::vector<std::vector<std::size_t>> needed;
    const auto find_needed = [&] { needed = needed_steps(done, assembly_, verifier_, context_); };
    // The two are independent.
    parallel_for(
        2, context_.executor.get(), [&](std::size_t k) { k == 0 ? put_together() : find_needed(); },
        [] { return false; });
    set_needed(result.plan, needed);
    auto overlaps = step_overlaps(done, assembly_, verifier_, options_.named_overlap, context_);
    for (std::size_t i = 0; i < overlaps.size(); ++i) result.plan.disassembly[i].overlaps = std::move(overlaps[i]);
    for (const auto& [a, b] : part_precedence(done, needed))
      result.precedence.emplace_back(assembly_.parts[a].name, assembly_.parts[b].name);
    judge(result.plan, done, assembly_, setup_.objective, context_);
    if (sequence_.least_cost && !result.plan.objective.empty())
      result.plan.objective.least_cost = std::min(*sequence_.least_cost, result.plan.objective.cost);
    add_first_order(result.plan, sequence_.counts);
    add_other_places(result.plan, done, needed, assembly_, setup_.objective, options_.constraints, context_);
    if (!puts_together) return;
    result.plan.assembly_steps = std::move(back.steps);
    result.plan.assembly_status = back.status;
    result.plan.assembly_message = std::move(back.message);
  }

  const Assembly& assembly_;
  const PlanningSetup& setup_;
  const RunOptions& options_;
  RunContext context_;
  const PreparedAssembly nothing_;  // the simulator prepares by itself
  const DeferredSimulator simulator_;
  const Verifier verifier_;
  Oracle oracle_;
  Recorder recorder_;
  std::optional<RequiringOracle> requiring_;  // when a check of the objective is required
  SequenceResult sequence_;
};

}  // namespace

RunResult run(const Assembly& assembly, const PlanningSetup& setup, const RunOptions& options, RunContext& context,
              const StepObserver& on_step) {
  check(assembly, setup, options);
  RunContext own = context;
  own.rng = Rng(options.seed);
  if (own.threads > 1 && !own.executor) own.executor = std::make_shared<Executor>(own.threads);
  if (!options.only_part.empty()) own.threads = 1;  // no speculative questions, and the planner's progress is shown
  return Run(assembly, setup, options, own, on_step)();
}

}  // namespace dismantle
