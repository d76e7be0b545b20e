#include "force_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "group_oracle.h"
#include "rng_streams.h"
#include "stopwatch.h"

namespace dismantle {

namespace {

/// Passes removals from a group on as removals from the whole assembly.
class GroupObserver final : public SequenceObserver {
 public:
  GroupObserver(const GroupOracle& oracle, SequenceObserver& whole) : oracle_(oracle), whole_(whole) {}
  void removed(const Removal& removal, std::size_t parts_left) override {
    whole_.removed(oracle_.in_whole(removal), parts_left);
  }

 private:
  const GroupOracle& oracle_;
  SequenceObserver& whole_;
};

}  // namespace

ForceSteps::ForceSteps(const Assembly& assembly, const Verifier& verifier, Oracle& oracle, PlanBuilder& builder,
                       SequencePlanner& planner, SequenceObserver& observer, const RunOptions& options)
    : assembly_(assembly),
      verifier_(verifier),
      oracle_(oracle),
      builder_(builder),
      planner_(planner),
      observer_(observer),
      options_(options),
      motions_(assembly, verifier, options.constraints, options.force),
      normalizer_(assembly) {}

/// The motions to measure: the most promising ones of each set of parts, in distinct directions.
std::vector<const ForcedMotion*> ForceSteps::chosen(const std::vector<ForcedMotion>& all) const {
  std::map<std::vector<PartId>, std::vector<const ForcedMotion*>> of_set;
  for (const ForcedMotion& m : all) of_set.try_emplace(ids_of_placed(m.moving));
  const std::size_t most =
      std::max<std::size_t>(options_.force.set_candidates, options_.force.candidates / of_set.size());
  std::vector<const ForcedMotion*> list;
  for (const ForcedMotion& m : all) {
    std::vector<const ForcedMotion*>& same = of_set[ids_of_placed(m.moving)];
    const auto alike = [&](const ForcedMotion* other) {
      return m.straight() && other->straight() &&
             m.twist.linear.dot(other->twist.linear) > options_.force.set_similarity;
    };
    if (same.size() >= most || std::any_of(same.begin(), same.end(), alike)) continue;
    same.push_back(&m);
    list.push_back(&m);
    if (list.size() == options_.force.candidates) break;
  }
  return list;
}

/// The motion that cuts in least: all are measured coarsely, then the best of them finely. When stopped: the best of
/// those compared so far, if any.
std::optional<ForceSteps::Choice> ForceSteps::best_of(const std::vector<const ForcedMotion*>& list,
                                                      const RunContext& context) {
  const double tolerance = verifier_.options().max_penetration;
  const ForceOptions& force = options_.force;
  MotionDepthOptions options{force.coarse_resolution * tolerance, force.coarse_share,
                             std::numeric_limits<double>::infinity(), static_cast<std::uint64_t>(force.coarse_poses)};
  const auto unsure = [&](double excess) { return excess + std::max(options.absolute, options.relative * excess); };
  std::vector<std::pair<Choice, std::size_t>> measured;  // with the index in the list
  double least = std::numeric_limits<double>::infinity();
  for (const ForcedMotion* m : list) {
    const auto found = motions_.depth(*m, options, context);
    if (context.should_stop()) break;
    measured.push_back({{*m, found}, measured.size()});
    least = std::min(least, measured.back().first.excess());
    options.stop_above = unsure(least);
  }
  std::stable_sort(measured.begin(), measured.end(),
                   [](const auto& a, const auto& b) { return a.first.excess() < b.first.excess(); });
  if (measured.empty()) return std::nullopt;
  const double worth_a_look = unsure(least);
  options = {tolerance, force.fine_share, std::numeric_limits<double>::infinity(),
             static_cast<std::uint64_t>(force.fine_poses)};
  std::optional<Choice> best;
  for (std::size_t k = 0; k < measured.size() && k < force.finalists && measured[k].first.excess() <= worth_a_look;
       ++k) {
    Choice now{measured[k].first.motion, motions_.depth(measured[k].first.motion, options, context)};
    if (context.should_stop()) break;
    if (best && now.excess() >= options.stop_above) continue;
    now.exact = !now.depth || now.depth->proved;
    best = std::move(now);
    options.stop_above = best->excess();
    if (best->excess() <= tolerance) break;
  }
  return best ? best : measured.front().first;
}

/// Compares all motions that may be the best, while there is time.
std::optional<ForceSteps::Choice> ForceSteps::measured_choice(const RunContext& context) {
  std::vector<ForcedMotion> all;
  for (const Placed& group : builder_.open_groups())
    for (ForcedMotion& m : motions_.candidates(group, context)) all.push_back(std::move(m));
  std::stable_sort(all.begin(), all.end(),
                   [](const ForcedMotion& a, const ForcedMotion& b) { return a.thickness < b.thickness; });
  return best_of(chosen(all), context);
}

/// The most promising of a few motions, with a lower bound of its depth from rays.
std::optional<ForceSteps::Choice> ForceSteps::quick_choice(const RunContext& context) {
  std::optional<ForcedMotion> best;
  for (const Placed& group : builder_.open_groups()) {
    std::optional<ForcedMotion> m = motions_.quick_candidate(group, context);
    if (m && (!best || more_promising(*m, *best))) best = std::move(m);
  }
  if (!best) return std::nullopt;
  const std::optional<MotionDepth> depth = motions_.least_depth(*best);
  return Choice{std::move(*best), depth};
}

/// A motion that nowhere exceeds the tolerance may pass verification; it is then recorded as a verified step.
bool ForceSteps::is_valid(const Choice& choice, RunContext& context) {
  if (choice.excess() > verifier_.options().max_penetration) return false;
  const Attempt question{choice.motion.moving, choice.motion.fixed};
  const AttemptResult& answer = oracle_.propose(question, motions_.path(choice.motion), context);
  if (!is_success(answer.result.outcome())) return false;
  observer_.removed({ids_of_placed(choice.motion.moving), &answer}, steps_left());
  return true;
}

bool ForceSteps::force_one(ForceBudget& budget, const RunContext& context) {
  const auto begin = std::chrono::steady_clock::now();
  std::optional<Choice> choice;
  RunContext own = context;
  own.deadline = budget.for_all();
  if (budget.limited()) choice = quick_choice(own);
  if (own.should_stop()) return false;
  double least_time = seconds_since(begin);
  own.deadline = budget.for_measuring(steps_left());
  if (!own.should_stop())
    if (std::optional<Choice> better = measured_choice(own)) choice = std::move(better);
  if (!choice || context.cancel.cancelled()) return false;
  RunContext to_the_end = context;  // a verified step may use the time of other steps
  if (is_valid(*choice, to_the_end)) return true;
  const ForcedMotion& motion = choice->motion;
  NormalizedPath written = normalizer_.normalize(motions_.path(motion), motion.moving);
  if (!written.problem.empty()) throw std::logic_error("a forced path is unusable: " + written.problem);
  if (!choice->exact) {
    const auto from = std::chrono::steady_clock::now();
    const auto found = motions_.depth(motion, written.path,
                                      {verifier_.options().max_penetration, options_.force.fine_share}, to_the_end);
    if (!choice->depth || (found && found->excess() >= choice->excess())) choice->depth = found;
    choice->exact = !to_the_end.should_stop();
    least_time += seconds_since(from);
  }
  budget.took(least_time);
  if (context.cancel.cancelled()) return false;
  const std::vector<PartId> parts = ids_of_placed(motion.moving);
  const MotionDepth stated = choice->depth.value_or(MotionDepth{parts.front(), motion.fixed.front().part});
  context.log(LogLevel::info, fmt::format("forced: '{}' past '{}', {}{:.4g} deep", assembly_.parts[stated.part].name,
                                          assembly_.parts[stated.other].name, choice->exact ? "" : "at least ",
                                          stated.depth / assembly_.normalization.scale));
  RunContext proving = context;
  proving.deadline = budget.for_planning(steps_left());
  const Certificate* proof = proving.should_stop()
                                 ? nullptr
                                 : oracle_.proofs().prove_pair(stated.part, stated.other, ProofEffort::medium, proving);
  builder_.force(parts, written.path, stated, choice->exact, proof, seconds_since(begin));
  return true;
}

/// Lets the sequence planner find verified removals from the remaining groups, in shallow searches.
void ForceSteps::take_apart(const ForceBudget& budget, RunContext& context) {
  RunContext own = context;
  for (const Placed& group : builder_.open_groups()) {
    own.deadline = budget.for_planning(steps_left());
    if (own.should_stop()) return;
    if (!tried_.insert(ids_of_placed(group)).second) continue;
    GroupOracle oracle(assembly_, oracle_, group, options_.force.retry_depth);
    GroupObserver observer(oracle, observer_);
    own.rng = Rng(options_.seed).fork(force_stream);
    try {
      planner_.plan(oracle.assembly(), oracle, observer, own);
    } catch (const std::exception& e) {
      context.log(LogLevel::error, fmt::format("the sequence planner failed on what was left: {}", e.what()));
    }
  }
}

/// Upper bound, since groups that the constraints keep together need fewer steps. At least one.
std::size_t ForceSteps::steps_left() const {
  std::size_t steps = 0;
  for (const Placed& group : builder_.open_groups()) steps += group.size() - 1;
  return std::max<std::size_t>(1, steps);
}

void ForceSteps::run(RunContext& context) {
  ForceBudget budget(context.deadline, options_.force);
  for (const Placed& group : builder_.open_groups()) tried_.insert(ids_of_placed(group));
  while (!context.cancel.cancelled() && !builder_.fulfilled() && force_one(budget, context))
    if (!builder_.fulfilled()) take_apart(budget, context);
}

}  // namespace dismantle
