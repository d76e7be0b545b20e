#include "attempt_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "dismantle/verification/verdict.h"
#include "stopwatch.h"

namespace dismantle {

namespace {

using Clock = std::chrono::steady_clock;

bool same_path(const Path& a, const Path& b) {
  const auto same_pose = [](const Pose& x, const Pose& y) { return x.t == y.t && x.q.coeffs() == y.q.coeffs(); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](const std::vector<Pose>& x, const std::vector<Pose>& y) {
                      return std::equal(x.begin(), x.end(), y.begin(), y.end(), same_pose);
                    });
}

bool holds(const std::vector<PlacedPart>& group, PartId part) {
  return std::any_of(group.begin(), group.end(), [part](const PlacedPart& p) { return p.part == part; });
}

/// What a plugin says about parts and poses is kept only as far as it makes sense.
void drop_nonsense(PathResult& result, const Attempt& attempt) {
  std::vector<PartId> blockers;
  for (const PartId id : result.blocked_by) {
    const bool stands =
        std::any_of(attempt.still.begin(), attempt.still.end(), [id](const PlacedPart& p) { return p.part == id; });
    if (stands && std::find(blockers.begin(), blockers.end(), id) == blockers.end()) blockers.push_back(id);
  }
  result.blocked_by = std::move(blockers);
  const bool finite = std::all_of(result.best_pose.begin(), result.best_pose.end(), [](const Pose& p) {
    return p.t.allFinite() && p.q.coeffs().allFinite() && std::abs(p.q.norm() - 1) < 1e-6;
  });
  if (!finite || result.best_pose.size() != attempt.moving.size()) result.best_pose.clear();
}

PathResult failure(Outcome outcome, std::string message) {
  PathResult result;
  result.outcome = outcome;
  result.message = std::move(message);
  return result;
}

}  // namespace

/// A path that the planner showed, in the form that is written, and what the judge said of it.
struct AttemptRunner::Judgement {
  Path given;
  NormalizedPath written;
  MotionCheck check;
  Verdict verdict;
  std::optional<PartId> out;  ///< who of Attempt::leaving
};

AttemptRunner::AttemptRunner(const Assembly& assembly, const Prepared& prepared, const Ingredients& ingredients,
                             const RunOptions& options, const Verifier& verifier, const Rng& rng)
    : assembly_(assembly),
      prepared_(prepared),
      simulator_(*ingredients.simulator),
      verifier_(verifier),
      planner_id_(ingredients.path_planner_id),
      path_timeout_(options.path_timeout),
      path_steps_(options.path_steps),
      rng_(rng),
      normalizer_(assembly) {}

std::string AttemptRunner::lacking(const Capabilities& needs, std::size_t moving) const {
  const Capabilities has = simulator_.capabilities();
  std::vector<std::string> missing;
  if (needs.dynamics && !has.dynamics) missing.emplace_back("dynamics");
  if (needs.contacts && !has.contacts) missing.emplace_back("contacts");
  if (needs.distance && !has.distance) missing.emplace_back("distance");
  if (moving > has.max_moving)
    missing.push_back(fmt::format("{} parts moving at once (it allows {})", moving, has.max_moving));
  if (missing.empty()) return {};
  return fmt::format("the simulator does not offer what path planner '{}' needs: {}", planner_id_,
                     fmt::join(missing, ", "));
}

/// The first of those that are leaving whose hull is apart from that of all others, the moving ones where `group` has
/// them.
std::optional<PartId> AttemptRunner::first_out(const Attempt& attempt, const std::vector<PlacedPart>& group) const {
  for (const PartId id : attempt.goal.any_of) {
    std::vector<PlacedPart> alone, others = attempt.still;
    for (const PlacedPart& p : group) (p.part == id ? alone : others).push_back(p);
    if (verifier_.apart(alone, others)) return id;
  }
  return std::nullopt;
}

AttemptRunner::Judgement AttemptRunner::judge(const Attempt& attempt, const Path& path,
                                              const RunContext& context) const {
  Judgement j;
  j.given = path;
  j.written = normalizer_.normalize(path, attempt.moving);
  if (!j.written.problem.empty()) {
    j.verdict.reason = j.written.problem;
    return j;
  }
  j.check = verifier_.check_motion(ids_of(attempt.moving), attempt.still, j.written.path, context);
  if (!j.check.valid) {
    j.verdict = verdict_of(j.check);
    j.verdict.reason =
        j.check.interrupted ? "the run was stopped before the path was judged" : "the path cuts into another part";
    if (j.check.violation) {
      const Violation& v = *j.check.violation;
      j.verdict.instant = j.written.given_instant(v.segment, v.u);
      const auto &from = j.written.path.at(v.segment), &to = j.written.path.at(v.segment + 1);
      for (std::size_t i = 0; i < from.size(); ++i) j.verdict.poses.push_back(screw_interpolate(from[i], to[i], v.u));
      const auto name = [&](PartId id) {
        return id < assembly_.parts.size() ? assembly_.parts[id].name : fmt::format("part {}", id);
      };
      j.verdict.reason =
          v.uncertain
              ? fmt::format("'{}' and '{}' could not be proved to stay out of each other", name(v.part), name(v.other))
              : fmt::format("'{}' cuts {:.4g} deep into '{}' ({:.4g} when assembled, {:.4g} more allowed)",
                            name(v.part), v.depth, name(v.other), v.allowed, verifier_.options().max_penetration);
    }
    return j;
  }
  if (attempt.goal.placement) {
    j.verdict.accepted = true;
    return j;
  }
  std::vector<PlacedPart> group = attempt.moving;
  for (std::size_t i = 0; i < group.size(); ++i) group[i].pose = j.written.path.back()[i];
  if (!attempt.goal.any_of.empty()) {
    j.out = first_out(attempt, group);
    j.verdict.accepted = j.out.has_value();
    if (!j.out) j.verdict.reason = "the path ends before any part that is to leave is apart from all others";
    return j;
  }
  if (!verifier_.apart(group, attempt.still)) {
    j.verdict.reason = "the path ends before the convex hulls are apart";
    return j;
  }
  j.verdict.accepted = true;
  return j;
}

ComputedAttempt AttemptRunner::judge_way(const Attempt& attempt, const Path& way, const RunContext& context) const {
  const Clock::time_point begin = Clock::now();
  ComputedAttempt computed;
  PathResult& result = computed.answer.result;
  if (way.empty() || way.front().size() != attempt.moving.size())
    throw std::invalid_argument("a proposed way needs instants, and one pose per moving part in each");
  for (std::size_t i = 0; i < attempt.moving.size(); ++i)
    if (!(way.front()[i].t == attempt.moving[i].pose.t) ||
        !way.front()[i].q.coeffs().isApprox(attempt.moving[i].pose.q.coeffs()))
      throw std::invalid_argument("a proposed way does not begin where its parts are");
  Judgement j;
  j = judge(attempt, way, context);
  result.outcome = j.verdict.accepted ? Outcome::solved : Outcome::exhausted;
  result.message = j.verdict.reason;
  result.depth = 1;
  if (j.verdict.accepted) {
    computed.answer.max_penetration = j.check.max_penetration;
    computed.answer.out = j.out;
    result.path = std::move(j.written.path);
  } else if (j.verdict.has_witness) {
    result.blocked_by = {holds(attempt.still, j.verdict.other) ? j.verdict.other : j.verdict.part};
  }
  drop_nonsense(result, attempt);
  computed.interrupted = !is_success(result.outcome) && context.should_stop();
  computed.answer.seconds = seconds_since(begin);
  return computed;
}

/// What is found just in time is judged: only the end of the `run` interrupts that.
PathResult AttemptRunner::plan(PathPlanner& planner, const Attempt& attempt, const AttemptResult* resumed,
                               const RunContext& context, const RunContext& run, Judgement& last) const {
  const std::string missing = lacking(planner.needs(), attempt.moving.size());
  if (!missing.empty()) return failure(Outcome::unsupported, missing);
  if (!attempt.goal.any_of.empty() && !planner.moves_each_its_way())
    return failure(Outcome::unsupported,
                   fmt::format("path planner '{}' does not move several parts each in its own way", planner_id_));
  RunContext own = context;
  const Effort effort{attempt.max_depth, path_steps_, path_timeout_};
  std::mutex last_guard;  // planners may ask from several threads
  const PathQuery query{assembly_,
                        simulator_,
                        prepared_,
                        {attempt.moving, attempt.still},
                        effort,
                        [&](const Path& path) {
                          Judgement judgement = judge(attempt, path, run);
                          Verdict verdict = judgement.verdict;
                          const std::scoped_lock lock(last_guard);
                          last = std::move(judgement);
                          return verdict;
                        },
                        attempt.goal.any_of,
                        resumed != nullptr ? resumed->result.reached.get() : nullptr};
  return planner.plan(query, own);
}

ComputedAttempt AttemptRunner::run(PathPlanner& planner, const Attempt& attempt, const AttemptKey& key,
                                   const AttemptResult* resumed, const RunContext& context) const {
  const Clock::time_point begin = Clock::now();
  ComputedAttempt computed;
  AttemptResult& answer = computed.answer;
  PathResult& result = answer.result;
  RunContext own = context;
  own.rng = rng_.fork(stream_of(key));
  if (path_timeout_ > 0) own.deadline = context.deadline.earlier(Deadline::after_seconds(path_timeout_));
  Judgement last;
  try {
    if (attempt.still.empty() && attempt.goal.any_of.empty()) {
      result.outcome = Outcome::start_is_goal;  // nothing left to be apart from
    } else {
      result = plan(planner, attempt, resumed, own, context, last);
    }
    if (result.outcome == Outcome::solved) {
      if (last.written.path.empty() || !same_path(last.given, result.path)) last = judge(attempt, result.path, context);
      if (last.verdict.accepted) {
        answer.max_penetration = last.check.max_penetration;
        answer.out = last.out;
        result.path = std::move(last.written.path);
      } else if (last.check.interrupted) {
        result = failure(context.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout, last.verdict.reason);
      } else {
        result.outcome = Outcome::crashed;
        result.message = fmt::format("path planner '{}' reports as solved a path that the judge refuses: {}",
                                     planner_id_, last.verdict.reason);
      }
    } else if (result.outcome == Outcome::start_is_goal) {
      std::vector<Pose> start;
      for (const auto& p : attempt.moving) start.push_back(p.pose);
      result.path = {start, start};
      result.depth = 0;
      answer.out = first_out(attempt, attempt.moving);
      const bool is_apart = attempt.goal.any_of.empty()
                                ? attempt.still.empty() || verifier_.apart(attempt.moving, attempt.still)
                                : answer.out.has_value();
      if (!is_apart) {
        result.outcome = Outcome::crashed;
        result.message = fmt::format(
            "path planner '{}' reports that there is nothing to do, but the convex hulls are not apart", planner_id_);
      }
    }
  } catch (const std::exception& e) {
    result = failure(Outcome::crashed, fmt::format("path planner '{}' threw: {}", planner_id_, e.what()));
  } catch (...) {
    result = failure(Outcome::crashed,
                     fmt::format("path planner '{}' threw something that is not a std::exception", planner_id_));
  }
  if (result.outcome == Outcome::crashed) context.log(LogLevel::error, result.message);
  if (!is_success(result.outcome)) {
    result.path.clear();
    const bool cancelled = context.cancel.cancelled();
    const bool too_late = context.deadline.passed();
    if (cancelled || too_late) {
      computed.interrupted = true;
      result.outcome = cancelled ? Outcome::cancelled : Outcome::timeout;
      result.message = cancelled ? "cancelled" : "the time limit of the whole run passed during the attempt";
    } else if (result.outcome == Outcome::cancelled) {
      if (own.deadline.passed()) {  // planners stop for both reasons at the same place
        result.outcome = Outcome::timeout;
      } else {
        result.outcome = Outcome::crashed;
        result.message = fmt::format("path planner '{}' stopped although nobody asked it to", planner_id_);
        context.log(LogLevel::error, result.message);
      }
    }
  }
  if (is_success(result.outcome) || result.outcome == Outcome::crashed || computed.interrupted)
    result.reached = nullptr;
  drop_nonsense(result, attempt);
  answer.seconds = seconds_since(begin);
  return computed;
}

}  // namespace dismantle
