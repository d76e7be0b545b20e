// Planning: prepares, asks the sequence planner, records its removals.
#include "dismantle/engine/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <utility>

#include "assembler.h"
#include "deferred_simulator.h"
#include "dismantle/errors.h"
#include "dismantle/executor.h"
#include "force_steps.h"
#include "oracle.h"
#include "plan_builder.h"
#include "precedence.h"
#include "rng_streams.h"
#include "step_overlaps.h"
#include "stopwatch.h"

namespace dismantle {

namespace {

using Clock = std::chrono::steady_clock;

Outcome why_stopped(const RunContext& context) {
  return context.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout;
}

void check(const Assembly& assembly, const PlanningSetup& setup, const RunOptions& options) {
  if (assembly.parts.empty()) throw InputError(assembly.source, "has no parts");
  for (std::size_t i = 0; i < assembly.parts.size(); ++i)
    if (assembly.parts[i].id != i || !assembly.parts[i].mesh)
      throw std::invalid_argument("parts of an assembly are numbered by their place and have meshes");
  if (!setup.simulator) throw std::invalid_argument("no simulator given");
  if (!setup.path_planner) throw std::invalid_argument("no path planner given");
  if (options.only_part.empty() && !setup.sequence_planner) throw std::invalid_argument("no sequence planner given");
  if (options.only_part.empty() && !options.constraints.empty() && !setup.sequence_planner->keeps_constraints())
    throw std::invalid_argument("there are constraints, and the sequence planner does not say that it keeps them");
}

PartId part_named(const Assembly& assembly, const std::string& name) {
  for (const auto& part : assembly.parts)
    if (part.name == name) return part.id;
  std::string names;
  for (const auto& part : assembly.parts) names += (names.empty() ? "'" : ", '") + part.name + "'";
  throw InputError(assembly.source, fmt::format("has no part '{}'; its parts are {}", name, names));
}

/// Records each removal as it comes and passes on the plan so far.
class RemovalRecorder final : public SequenceObserver {
 public:
  RemovalRecorder(PlanBuilder& builder, const std::function<void(const Plan&)>& on_step, const RunContext& context)
      : builder_(builder), on_step_(on_step), context_(context) {}

  /// Throws std::logic_error for an invalid removal, which stops the sequence planner.
  void removed(const Removal& removal, std::size_t /*parts_left*/) override {
    if (!problem_.empty()) throw std::logic_error(problem_);  // the planner ignored an earlier error
    try {
      builder_.record(removal);
    } catch (const std::logic_error& e) {
      problem_ = e.what();
      throw;
    }
    if (!on_step_) return;
    try {
      on_step_(builder_.plan());
    } catch (const std::exception& e) {  // the run continues; the next step tries again
      context_.log(LogLevel::error, fmt::format("the plan so far could not be passed on: {}", e.what()));
    }
  }
  const std::string& problem() const { return problem_; }

 private:
  PlanBuilder& builder_;
  const std::function<void(const Plan&)>& on_step_;
  const RunContext& context_;
  std::string problem_;
};

SequenceResult plan_sequence(const Assembly& assembly, SequencePlanner& planner, Oracle& oracle,
                             RemovalRecorder& recorder, const RunContext& context) {
  RunContext own = context;
  own.rng = context.rng.fork(sequence_stream);
  SequenceResult result;
  std::string problem;
  try {
    result = planner.plan(assembly, oracle, recorder, own);
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

SequenceResult plan_one(const Assembly& assembly, PartId part, Oracle& oracle, RemovalRecorder& recorder,
                        RunContext context) {
  Attempt attempt;
  for (const auto& p : assembly.parts) (p.id == part ? attempt.moving : attempt.fixed).push_back({p.id, Pose{}});
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

/// Tries proofs for remaining parts that have none, independent of the planners used. A proof explains more than the
/// message of a search does.
void prove_left(std::vector<Unsolved>& unsolved, const PlanBuilder& builder, Oracle& oracle,
                const ProofOptions& options, const RunContext& context) {
  std::size_t asked = 0;
  for (Unsolved& u : unsolved) {
    const bool open =
        u.certificate == nullptr && !context.should_stop() && asked < options.final_parts &&
        (u.outcome == Outcome::depth_limit || u.outcome == Outcome::exhausted || u.outcome == Outcome::timeout);
    if (open) {
      ++asked;
      std::vector<PartId> group{u.part};
      for (const PlacedPart& other : builder.around(u.part)) group.push_back(other.part);
      u.certificate = oracle.proofs().at_last(u.part, u.blocked_by, group, context);
    }
    if (u.certificate == nullptr) continue;
    if (u.certificate->full_tolerance) u.outcome = Outcome::infeasible;
    u.message = u.certificate->text;
    u.blocked_by = u.certificate->parts;
    std::erase(u.blocked_by, u.part);
  }
}

/// Contacts of a remaining part with others at its best pose, from the simulator.
ContactsOf contacts_of(const Assembly& assembly, const DeferredSimulator& simulator, const PlanBuilder& builder,
                       const RunContext& context) {
  if (!simulator.capabilities().contacts) return {};
  return [&](PartId part, const Pose& at) {
    std::vector<Contact> deepest;
    if (context.should_stop()) return deepest;
    try {
      const Scene scene{{{part, at}}, builder.around(part)};
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

/// The sequence planner's reasons for the remaining parts, completed, without impossible claims.
std::vector<Unsolved> reasons(const SequenceResult& said, const std::vector<PartId>& left) {
  const auto is_left = [&left](PartId id) { return std::find(left.begin(), left.end(), id) != left.end(); };
  std::vector<Unsolved> result;
  for (const auto& u : said.unsolved)
    if (is_left(u.part)) result.push_back(u);
  for (const PartId id : left) {
    const auto same = [id](const Unsolved& u) { return u.part == id; };
    if (std::any_of(result.begin(), result.end(), same)) continue;
    const bool planned = said.outcome != Outcome::cancelled && said.outcome != Outcome::timeout;
    result.push_back({id,
                      is_success(said.outcome) ? Outcome::crashed : said.outcome,
                      {},
                      {},
                      planned ? "the sequence planner gave no reason" : "not tried: the run was stopped before"});
  }
  for (auto& u : result) {
    std::erase_if(u.blocked_by, [&](PartId id) { return !is_left(id); });
    const auto is_about = [&](const Certificate& c) {
      return std::find(c.parts.begin(), c.parts.end(), u.part) != c.parts.end();
    };
    if (u.certificate != nullptr && !is_about(*u.certificate)) u.certificate = nullptr;
    // A claim without a certificate cannot be checked.
    if (u.outcome == Outcome::infeasible && (u.certificate == nullptr || !u.certificate->full_tolerance))
      u.outcome = Outcome::exhausted;
  }
  return result;
}

}  // namespace

RunResult run(const Assembly& assembly, const PlanningSetup& setup, const RunOptions& options, RunContext& context,
              const std::function<void(const Plan&)>& on_step) {
  check(assembly, setup, options);
  const bool only_one = !options.only_part.empty();
  const PartId part = only_one ? part_named(assembly, options.only_part) : 0;
  if (setup.transfer_planner && options.layout.enabled)
    for (const auto& entry : options.layout.poses) part_named(assembly, entry.first);
  RunContext own = context;
  own.rng = Rng(options.seed);
  const bool forces = options.force.when == ForceWhen::last_resort && !only_one;
  if (const double left = context.deadline.seconds_left(); forces && std::isfinite(left))
    own.deadline = Deadline::after_seconds((1 - options.force.share) * left);
  if (own.threads > 1 && !own.executor) own.executor = std::make_shared<Executor>(own.threads);

  RunResult result;
  const Clock::time_point begin = Clock::now();
  const DeferredSimulator simulator(*setup.simulator, assembly, options.verify.max_penetration, own);
  RunContext whole = own;  // forced steps need the verifier, too
  whole.deadline = context.deadline;
  const Verifier verifier(assembly, options.verify, whole);
  const PreparedAssembly nothing;
  if (only_one) own.threads = 1;  // there are no speculative questions, and the planner's progress is shown
  Oracle oracle(assembly, nothing, setup, &simulator, options, verifier, own);
  PlanBuilder builder(assembly, oracle, options, setup.path_planner_id);
  RemovalRecorder recorder(builder, on_step, own);
  SequenceResult sequence;
  if (own.should_stop())
    sequence.outcome = why_stopped(own);
  else if (only_one)
    sequence = plan_one(assembly, part, oracle, recorder, own);
  else
    sequence = plan_sequence(assembly, *setup.sequence_planner, oracle, recorder, own);
  simulator.rethrow_failure();
  if (simulator.was_stopped()) sequence.outcome = why_stopped(own);

  const ContactsOf places = contacts_of(assembly, simulator, builder, own);
  result.outcome = sequence.outcome;
  result.sequence_counts = sequence.counts;
  if (only_one) {
    builder.set_unsolved(sequence.unsolved, places);
  } else if (builder.fulfilled()) {
    result.outcome = Outcome::solved;
  } else {
    if (is_success(sequence.outcome)) {
      result.outcome = Outcome::crashed;
      own.log(LogLevel::error,
              fmt::format("the sequence planner reports success with {} parts still together", builder.left().size()));
    }
    std::vector<Unsolved> unsolved = reasons(sequence, builder.left());
    prove_left(unsolved, builder, oracle, options.proofs, own);
    builder.set_unsolved(unsolved, places);
    own.deadline = context.deadline;
    if (forces && result.outcome != Outcome::crashed && !own.cancel.cancelled()) {
      ForceSteps(assembly, verifier, oracle, builder, *setup.sequence_planner, recorder, options).run(own);
      simulator.rethrow_failure();
      if (builder.fulfilled() && builder.forced() == 0) result.outcome = Outcome::solved;
      builder.drop_solved();
    }
  }
  AssemblyPlan back;
  const bool puts_together = setup.transfer_planner && options.layout.enabled && !builder.recorded().empty();
  const auto put_together = [&] {
    if (!puts_together) return;
    RunContext putting = own;
    putting.rng = Rng(options.seed).fork(transfer_stream);
    back = Assembler(assembly, simulator, setup, options, verifier)
               .put_together(builder.recorded(), builder.plan().disassembly, putting);
  };
  std::vector<std::vector<std::size_t>> needed;
  const auto find_needed = [&] { needed = needed_steps(builder.recorded(), assembly, verifier, own); };
  // The two are independent.
  parallel_for(
      2, own.executor.get(), [&](std::size_t k) { k == 0 ? put_together() : find_needed(); }, [] { return false; });
  builder.set_needed(needed);
  builder.set_overlaps(step_overlaps(builder.recorded(), assembly, verifier, options.named_overlap, own));
  for (const auto& [a, b] : part_precedence(builder.recorded(), needed))
    result.precedence.emplace_back(assembly.parts[a].name, assembly.parts[b].name);
  if (puts_together) builder.set_assembly(std::move(back.steps), back.status, std::move(back.message));
  result.plan = builder.plan();
  result.counts = oracle.counts();
  result.planner_counts = oracle.planner_counts();
  simulator.rethrow_failure();  // failure during a transfer
  result.prepare_seconds = simulator.seconds();
  result.plan_seconds = seconds_since(begin) - result.prepare_seconds;
  result.proof_seconds = oracle.proof_seconds();
  return result;
}

}  // namespace dismantle
