#include "least_cut/least_cut.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "least_cut/comparison.h"
#include "least_cut/force_budget.h"
#include "least_cut/forced_motions.h"

namespace dismantle {

void LeastCutParameters::describe(Schema<LeastCutParameters>& s) {
  s.add(
      "directions", &LeastCutParameters::directions,
      {.unit = "1",
       .min = 0,
       .max = 1000,
       .doc = "Number of directions, spread over a sphere, that a forced step may take in addition to the axes of the "
              "parts' faces."});
  s.add("candidates", &LeastCutParameters::candidates,
        {.unit = "1",
         .min = 1,
         .max = 100000,
         .doc = "Number of motions whose depth is measured for one forced step, most promising first."});
  s.advanced("quick_margin", &LeastCutParameters::quick_margin, {.min = 1, .max = 100});
  s.advanced("overtime", &LeastCutParameters::overtime, {.min = 0, .max = 3600});
  s.advanced("part_axes", &LeastCutParameters::part_axes, {.min = 1, .max = 1000});
  s.advanced("group_axes", &LeastCutParameters::group_axes, {.min = 1, .max = 1000});
  s.advanced("quick_axes", &LeastCutParameters::quick_axes, {.min = 1, .max = 1000});
  s.advanced("rays", &LeastCutParameters::rays, {.min = 1, .max = 100000});
  s.advanced("blocking_share", &LeastCutParameters::blocking_share, {.min = 0, .max = 1});
  s.advanced("firm_share", &LeastCutParameters::firm_share, {.min = 0, .max = 1});
  s.advanced("clearance", &LeastCutParameters::clearance, {.min = 1, .max = 1000});
  s.advanced("max_turns", &LeastCutParameters::max_turns, {.min = 0, .max = 10000});
  s.advanced("set_candidates", &LeastCutParameters::set_candidates, {.min = 1, .max = 100000});
  s.advanced("set_similarity", &LeastCutParameters::set_similarity, {.min = -1, .max = 1});
  s.advanced("depth_samples", &LeastCutParameters::depth_samples, {.min = 1, .max = 100000});
  s.advanced("finalists", &LeastCutParameters::finalists, {.min = 1, .max = 100000});
  s.advanced("depth_resolution", &LeastCutParameters::depth_resolution, {.min = 1, .max = 1000});
  s.advanced("depth_share", &LeastCutParameters::depth_share, {.min = 0.001, .max = 1});
  s.advanced("outlook_depths", &LeastCutParameters::outlook_depths, {.min = 0, .max = 1000000});
  s.advanced("depth_poses", &LeastCutParameters::depth_poses, {.min = 1, .max = 1e9});
}

namespace least_cut {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// What the steps of one run share; it lives in the memo of the oracle.
struct Session {
  Session(const SequenceQuery& query, PathOracle& oracle, const LeastCutParameters& params)
      : motions(query.assembly, oracle, query.constraints, params) {}
  ForcedMotions motions;
  double slowest_quick_step = 0;  // seconds
  bool proofs_tried = false;      // about the parts that are left
};

Session& session_of(const SequenceQuery& query, PathOracle& oracle, const LeastCutParameters& params) {
  return **oracle.memo()->get<std::shared_ptr<Session>>(
      "least_cut", 0, RunContext{}, [&] { return std::optional(std::make_shared<Session>(query, oracle, params)); });
}

/// One forced step.
class Step {
 public:
  Step(const LeastCutParameters& params, const SequenceQuery& query, PathOracle& oracle, Session& session,
       RunContext& context)
      : params_(params),
        query_(query),
        oracle_(oracle),
        motions_(session.motions),
        context_(context),
        session_(session),
        budget_(context.deadline, params, session.slowest_quick_step) {}

  /// The answer to record; null: none was found, or the run is stopped.
  const AttemptResult* make(std::span<const Unsolved> said) {
    const Clock::time_point begin = Clock::now();
    std::optional<Choice> choice;
    RunContext own = context_;
    own.deadline = budget_.for_all();
    if (budget_.limited()) choice = quick_choice(own);
    if (own.should_stop()) return nullptr;
    session_.slowest_quick_step = std::max(session_.slowest_quick_step, seconds_since(begin));
    own.deadline = budget_.for_measuring(steps_left());
    if (!own.should_stop())
      if (std::optional<Choice> better = Comparison(motions_, params_, oracle_.tolerance()).best(groups(), own))
        choice = std::move(better);
    if (!choice || context_.cancel.cancelled()) return nullptr;
    const Attempt question{choice->motion.moving, choice->motion.fixed};
    const Path path = motions_.path(choice->motion);
    if (choice->measured && choice->excess() <= oracle_.tolerance()) {  // it may be valid
      const AttemptResult& answer = oracle_.propose(question, path, context_);
      if (is_success(answer.result.outcome())) return &answer;
    }
    own.deadline = budget_.for_all();
    if (choice->depth) choice->depth->proved = choice->measured;
    const AttemptResult& answer = oracle_.forcing()->propose_forced(question, path, choice->depth, said, own);
    // A required check of the objective may not allow it.
    return context_.cancel.cancelled() || !answer.removes() ? nullptr : &answer;
  }

 private:
  /// The most promising of a few motions, with a lower bound of its depth from rays.
  std::optional<Choice> quick_choice(const RunContext& context) {
    std::optional<ForcedMotion> best;
    for (const Placed& group : query_.start) {
      std::optional<ForcedMotion> m = motions_.quick_candidate(group, context);
      if (m && (!best || more_promising(*m, *best))) best = std::move(m);
    }
    if (!best) return std::nullopt;
    const std::optional<MotionDepth> depth = motions_.least_depth(*best);
    return Choice{std::move(*best), depth};
  }

  std::vector<Placed> groups() const { return {query_.start.begin(), query_.start.end()}; }

  /// Upper bound, since groups that the constraints keep together need fewer steps.
  std::size_t steps_left() const {
    std::size_t steps = 0;
    for (const Placed& group : query_.start) steps += group.size() - 1;
    return std::max<std::size_t>(1, steps);
  }

  const LeastCutParameters& params_;
  const SequenceQuery& query_;
  PathOracle& oracle_;
  ForcedMotions& motions_;
  RunContext& context_;
  Session& session_;
  ForceBudget budget_;
};

}  // namespace
}  // namespace least_cut

SequenceResult LeastCut::plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                              RunContext& context) {
  SequenceResult result;
  result.outcome = Outcome::exhausted;
  result.unsolved.assign(query.said.begin(), query.said.end());
  bool apart = true;
  for (const auto& group : query.start) {
    for (const PlacedPart& p : group) result.remaining.push_back(p.part);
    apart = apart && group.size() < 2;
  }
  if (apart) {
    result.outcome = Outcome::solved;
    result.unsolved.clear();
    return result;
  }
  const bool forces = oracle.forcing() != nullptr && oracle.memo() != nullptr;
  if (context.cancel.cancelled()) result.outcome = Outcome::cancelled;
  if (!forces && result.outcome != Outcome::cancelled && context.should_stop()) result.outcome = Outcome::timeout;
  for (const PartId id : result.remaining)
    if (std::none_of(result.unsolved.begin(), result.unsolved.end(), [id](const Unsolved& u) { return u.part == id; }))
      result.unsolved.push_back({id, result.outcome, {}, {}, "no verified path was searched for"});
  if (!forces || context.cancel.cancelled()) return result;
  least_cut::Session& session = least_cut::session_of(query, oracle, params_);
  if (!session.proofs_tried) oracle.forcing()->prove_left(result.unsolved, query.start, context);
  session.proofs_tried = true;
  const AttemptResult* answer = least_cut::Step(params_, query, oracle, session, context).make(result.unsolved);
  if (answer == nullptr) {
    result.outcome = context.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout;
    return result;
  }
  const std::vector<PartId> moved = ids_of(answer->attempt.moving);
  result.removals.push_back({moved, answer});
  std::erase_if(result.remaining, [&](PartId id) { return contains(moved, id); });
  observer.removed(result.removals.back(), result.remaining.size());
  return result;
}

}  // namespace dismantle
