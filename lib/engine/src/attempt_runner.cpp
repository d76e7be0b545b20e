#include "attempt_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <utility>

#include "dismantle/geometry/edge_checker.h"
#include "stopwatch.h"

namespace dismantle {

namespace {

using Clock = std::chrono::steady_clock;

bool holds(const std::vector<PlacedPart>& group, PartId part) {
  return std::any_of(group.begin(), group.end(), [part](const PlacedPart& p) { return p.part == part; });
}

/// Drops invalid parts and poses from the result of a plugin.
void drop_nonsense(PathResult& result, const Attempt& attempt) {
  std::vector<PartId> blockers;
  for (const PartId id : result.blocked_by) {
    const bool stands =
        std::any_of(attempt.fixed.begin(), attempt.fixed.end(), [id](const PlacedPart& p) { return p.part == id; });
    if (stands && std::find(blockers.begin(), blockers.end(), id) == blockers.end()) blockers.push_back(id);
  }
  result.blocked_by = std::move(blockers);
  const bool finite = std::all_of(result.best_pose.begin(), result.best_pose.end(), [](const Pose& p) {
    return p.t.allFinite() && p.q.coeffs().allFinite() && std::abs(p.q.norm() - 1) < 1e-6;
  });
  if (!finite || result.best_pose.size() != attempt.moving.size()) result.best_pose.clear();
}

/// A search in portions, with a time limit that does not cover what is done between them.
class TimedSearch {
 public:
  /// `limit`: seconds of all portions together; 0 = none.
  TimedSearch(PathSearch& search, double limit) : search_(search), limit_(limit) {}

  /// Runs it for `max_steps`, 0 = to its end. False: it is over, or its time is up.
  bool goes_on(std::uint64_t max_steps) {
    const Clock::time_point begin = Clock::now();
    status_ = search_.run({.max_steps = max_steps, .timeout = limit_ > 0 ? limit_ - spent_ : 0});
    spent_ += seconds_since(begin);
    return status_ == SearchStatus::paused && !time_is_up();
  }

  /// Looks for better paths with so many steps and state checks, as long as the search says that there may be some.
  PathResult improved(std::uint64_t steps) {
    PathResult best = result();
    while (is_success(best.outcome()) && best.may_improve && steps > 0 && !time_is_up()) {
      const std::uint64_t before = effort(best);
      goes_on(steps);
      PathResult next = search_.result();
      if (!is_success(next.outcome())) break;  // the path that it had counts
      const std::uint64_t spent = effort(next) - std::min(before, effort(next));
      if (spent == 0) break;
      steps -= std::min(steps, spent);
      best = std::move(next);
    }
    return best;
  }

  PathResult result() {
    PathResult result = search_.result();
    if (status_ == SearchStatus::paused && time_is_up()) result.fail(Outcome::timeout);
    return result;
  }

 private:
  static std::uint64_t effort(const PathResult& result) { return result.stats.steps + result.stats.state_checks; }
  bool time_is_up() const { return limit_ > 0 && spent_ >= limit_; }

  PathSearch& search_;
  double limit_, spent_ = 0;
  SearchStatus status_ = SearchStatus::paused;
};

}  // namespace

/// Path checker of one attempt.
class AttemptRunner::Checker final : public PathChecker, public geometry::EdgeChecker {
 public:
  /// All references must outlive it. `context` interrupts a running check.
  Checker(const AttemptRunner& runner, const Attempt& attempt, const RunContext& context)
      : runner_(runner), attempt_(attempt), context_(context) {}

  PathCheck check(const Path& path) const override {
    PathCheck answer;
    NormalizedPath written = runner_.normalizer_.normalize(path, attempt_.moving);
    answer.reason = written.problem;
    if (!answer.reason.empty()) return answer;
    const MotionCheck motion =
        runner_.verifier_.check_motion(ids_of(attempt_.moving), attempt_.fixed, written.path, context_);
    if (!motion.valid) {
      runner_.explain(motion, written, answer);
      return answer;
    }
    std::optional<PartId> released;
    if (!attempt_.goal.placement) {
      std::vector<PlacedPart> group = attempt_.moving;
      for (std::size_t i = 0; i < group.size(); ++i) group[i].pose = written.path.back()[i];
      released = runner_.first_out(attempt_, group);
      if (!attempt_.goal.any_of.empty() && !released)
        answer.reason = "the path ends before any part that is to leave is apart from all others";
      else if (attempt_.goal.any_of.empty() && !runner_.verifier_.apart(group, attempt_.fixed))
        answer.reason = "the path ends before the convex hulls are apart";
      else if (leaves_in_excluded_direction(written.path))
        answer.reason = "the parts leave in a direction that the question excludes";
      if (!answer.reason.empty()) return answer;
    }
    answer.verified = accept(std::move(written.path), motion.max_penetration, released);
    return answer;
  }

  PathCheck check_edge(const std::vector<Pose>& from, const std::vector<Pose>& to) const override {
    PathCheck answer;
    const auto usable = [&](const std::vector<Pose>& poses) {
      return poses.size() == attempt_.moving.size() && std::all_of(poses.begin(), poses.end(), [](const Pose& p) {
               return p.t.allFinite() && p.q.coeffs().allFinite() && std::abs(p.q.norm() - 1) < 1e-6;
             });
    };
    if (!usable(from) || !usable(to)) {
      answer.reason = "an edge needs one finite pose for each moving part at both ends";
      return answer;
    }
    NormalizedPath edge;
    edge.path = {from, to};
    edge.lengths = edge.given_lengths = {0, 1};
    const MotionCheck motion =
        runner_.verifier_.check_motion(ids_of(attempt_.moving), attempt_.fixed, edge.path, context_);
    if (!motion.valid) runner_.explain(motion, edge, answer);
    return answer;
  }

  /// The path without motion, if the goal is reached at the start; otherwise empty.
  std::optional<VerifiedPath> rest() const {
    const std::optional<PartId> released = runner_.first_out(attempt_, attempt_.moving);
    const bool is_apart = attempt_.goal.any_of.empty()
                              ? attempt_.fixed.empty() || runner_.verifier_.apart(attempt_.moving, attempt_.fixed)
                              : released.has_value();
    if (!is_apart) return std::nullopt;
    std::vector<Pose> start;
    for (const auto& p : attempt_.moving) start.push_back(p.pose);
    return accept({start, start}, 0, released);
  }

 private:
  bool leaves_in_excluded_direction(const Path& path) const {
    const Eigen::Vector3d out = runner_.normalizer_.displacement(path, attempt_.moving);
    return std::any_of(attempt_.goal.without.begin(), attempt_.goal.without.end(), [&](const Eigen::Vector3d& d) {
      return out.dot(d) > out.norm() * std::cos(attempt_.goal.angle);
    });
  }

  const AttemptRunner& runner_;
  const Attempt& attempt_;
  const RunContext& context_;
};

AttemptRunner::AttemptRunner(const Assembly& assembly, const PreparedAssembly& prepared, const PlanningSetup& setup,
                             const DeferredSimulator* deferred, const RunOptions& options, const Verifier& verifier,
                             const Rng& rng)
    : assembly_(assembly),
      prepared_(prepared),
      deferred_(deferred),
      simulator_(deferred != nullptr ? static_cast<const Simulator&>(*deferred) : *setup.simulator),
      verifier_(verifier),
      planner_id_(setup.path_planner_id),
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
    missing.push_back(fmt::format("{} parts moving simultaneously (it allows {})", moving, has.max_moving));
  if (missing.empty()) return {};
  return fmt::format("the simulator does not offer what path planner '{}' needs: {}", planner_id_,
                     fmt::join(missing, ", "));
}

/// The first part of Goal::any_of whose hull is apart from that of all others; moving parts are at the poses of
/// `group`.
std::optional<PartId> AttemptRunner::first_out(const Attempt& attempt, const std::vector<PlacedPart>& group) const {
  for (const PartId id : attempt.goal.any_of) {
    std::vector<PlacedPart> alone, others = attempt.fixed;
    for (const PlacedPart& p : group) (p.part == id ? alone : others).push_back(p);
    if (verifier_.apart(alone, others)) return id;
  }
  return std::nullopt;
}

/// Why `written` is refused.
void AttemptRunner::explain(const MotionCheck& motion, const NormalizedPath& written, PathCheck& answer) const {
  answer.reason =
      motion.interrupted ? "the run was stopped before the path was verified" : "the path cuts into another part";
  if (!motion.violation) return;
  const Violation& v = *motion.violation;
  const double scale = assembly_.normalization.scale;  // messages use input units
  answer.has_witness = true;
  answer.part = v.part;
  answer.other = v.other;
  answer.point = v.point;
  answer.instant = written.given_instant(v.segment, v.u);
  const auto &from = written.path.at(v.segment), &to = written.path.at(v.segment + 1);
  for (std::size_t i = 0; i < from.size(); ++i) answer.poses.push_back(screw_interpolate(from[i], to[i], v.u));
  const auto name = [&](PartId id) {
    return id < assembly_.parts.size() ? assembly_.parts[id].name : fmt::format("part {}", id);
  };
  answer.reason =
      v.uncertain
          ? fmt::format("'{}' and '{}' could not be proved to stay out of each other", name(v.part), name(v.other))
          : fmt::format("'{}' cuts {:.4g} deep into '{}' ({:.4g} when assembled, {:.4g} more allowed{})", name(v.part),
                        v.depth / scale, name(v.other), v.allowed / scale, verifier_.options().max_penetration / scale,
                        assembly_.unit.empty() ? "" : "; " + assembly_.unit);
}

ComputedAttempt AttemptRunner::check_proposal(const Attempt& attempt, const Path& path,
                                              const RunContext& context) const {
  const Clock::time_point begin = Clock::now();
  ComputedAttempt computed;
  PathResult& result = computed.answer.result;
  if (path.empty() || path.front().size() != attempt.moving.size())
    throw std::invalid_argument("a proposed way needs instants, and one pose per moving part in each");
  for (std::size_t i = 0; i < attempt.moving.size(); ++i)
    if (!(path.front()[i].t == attempt.moving[i].pose.t) ||
        !path.front()[i].q.coeffs().isApprox(attempt.moving[i].pose.q.coeffs()))
      throw std::invalid_argument("a proposed way does not begin where its parts are");
  PathCheck check = Checker(*this, attempt, context).check(path);
  if (check.accepted()) {
    computed.answer.max_penetration = check.verified->max_penetration();
    computed.answer.out = check.verified->released();
    result.solve(std::move(*check.verified), 1);
  } else {
    result.fail(Outcome::exhausted, check.reason);
    result.depth = 1;
    if (check.has_witness) result.blocked_by = {holds(attempt.fixed, check.other) ? check.other : check.part};
  }
  drop_nonsense(result, attempt);
  computed.interrupted = !is_success(result.outcome()) && context.should_stop();
  computed.answer.seconds = seconds_since(begin);
  return computed;
}

PathResult AttemptRunner::plan(PathPlanner& planner, const Attempt& attempt, const AttemptResult* resumed,
                               RunContext& context, const Checker& checker, const std::vector<SearchPause>& pauses,
                               AttemptResult& answer) const {
  const PathPlannerTraits traits = planner.traits();
  const std::string missing = lacking(traits.needs, attempt.moving.size());
  if (!missing.empty()) return PathResult::failure(Outcome::unsupported, missing);
  if (!attempt.goal.any_of.empty() && !traits.simultaneous_motion)
    return PathResult::failure(
        Outcome::unsupported,
        fmt::format("path planner '{}' does not move several parts independently at the same time", planner_id_));
  const PathQuery query{assembly_,
                        simulator_,
                        prepared_,
                        {attempt.moving, attempt.fixed},
                        {attempt.max_depth, path_steps_, pauses.empty() ? path_timeout_ : 0},
                        verifier_.options().max_penetration,
                        checker,
                        attempt.goal,
                        resumed != nullptr ? resumed->result.state.get() : nullptr};
  const std::unique_ptr<PathSearch> search = planner.start(query, context);
  TimedSearch timed(*search, pauses.empty() ? 0 : path_timeout_);
  std::uint64_t spent = 0;
  for (const SearchPause& pause : pauses) {
    if (!timed.goes_on(pause.steps - spent)) return timed.improved(attempt.improve_steps);
    spent = pause.steps;
    const Clock::time_point begin = Clock::now();
    answer.certificate = pause.proof(search->result().blocked_by);
    answer.proof_seconds += seconds_since(begin);
    if (answer.certificate != nullptr) {
      PathResult result = search->result();
      result.fail(Outcome::infeasible, answer.certificate->text);
      return result;
    }
  }
  while (timed.goes_on(0)) {
  }
  return timed.improved(attempt.improve_steps);
}

/// Prepares the parts, so that worlds can be made; on failure fills `result`.
bool AttemptRunner::is_prepared(const RunContext& context, PathResult& result) const {
  try {
    if (deferred_ == nullptr || deferred_->ready(context)) return true;
    result.fail(context.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout,
                "the run was stopped before the parts were prepared");
  } catch (const Error& e) {  // the run ends with this error
    result.fail(Outcome::crashed, e.what());
  }
  return false;
}

ComputedAttempt AttemptRunner::run(PathPlanner& planner, const Attempt& attempt, const AttemptKey& key,
                                   const AttemptResult* resumed, const std::vector<SearchPause>& pauses,
                                   const RunContext& context) const {
  ComputedAttempt computed;
  AttemptResult& answer = computed.answer;
  PathResult& result = answer.result;
  const bool nothing_left = attempt.fixed.empty() && attempt.goal.any_of.empty();
  if (!nothing_left && !is_prepared(context, result)) {  // not counted as time of the attempt
    computed.interrupted = context.should_stop();
    return computed;
  }
  const Clock::time_point begin = Clock::now();
  RunContext own = context;
  own.rng = rng_.fork(stream_of(key));
  if (path_timeout_ > 0 && pauses.empty())
    own.deadline = context.deadline.earlier(Deadline::after_seconds(path_timeout_));
  // A path that was found shortly before this deadline is still verified: only the end of the run interrupts a check.
  const Checker checker(*this, attempt, context);
  bool false_claim = false;  // of a success: the planner's fault, even after the deadline
  try {
    if (nothing_left) {
      result.start_is_goal();  // nothing left to be apart from
    } else {
      result = plan(planner, attempt, resumed, own, checker, pauses, answer);
    }
    if (result.outcome() == Outcome::start_is_goal) {
      if (std::optional<VerifiedPath> rest = checker.rest()) {
        answer.out = rest->released();
        result.start_is_goal(std::move(rest));
      } else {
        false_claim = true;
        result.fail(Outcome::crashed,
                    fmt::format("path planner '{}' reports that there is nothing to do, but the convex hulls are not "
                                "apart",
                                planner_id_));
      }
    } else if (result.path() && checker.accepted(*result.path())) {
      answer.max_penetration = result.path()->max_penetration();
      answer.out = result.path()->released();
    } else if (result.path()) {
      false_claim = true;
      const PathCheck check = checker.check(result.path()->poses());
      result.fail(
          Outcome::crashed,
          fmt::format(
              "path planner '{}' reports as solved a path that was not verified for this attempt ({}); it has to "
              "return what query.checker.check() gave it, see 'dismantle plugins check'",
              planner_id_, check.accepted() ? "it would have been accepted" : check.reason));
    }
  } catch (const std::exception& e) {
    result = PathResult::failure(Outcome::crashed, fmt::format("path planner '{}' threw: {}", planner_id_, e.what()));
  } catch (...) {
    result = PathResult::failure(
        Outcome::crashed, fmt::format("path planner '{}' threw something that is not a std::exception", planner_id_));
  }
  if (result.outcome() == Outcome::crashed) context.log(LogLevel::error, result.message);
  if (!is_success(result.outcome()) && !false_claim) {
    const bool cancelled = context.cancel.cancelled();
    const bool too_late = context.deadline.passed();
    if (cancelled || too_late) {
      computed.interrupted = true;
      if (cancelled)
        result.fail(Outcome::cancelled, "cancelled");
      else if (result.outcome() != Outcome::crashed)  // the time limit does not explain a crash
        result.fail(Outcome::timeout, "the time limit of the whole run passed during the attempt");
    } else if (result.outcome() == Outcome::cancelled) {
      if (own.deadline.passed()) {  // planners report both reasons alike
        result.fail(Outcome::timeout);
      } else {
        result.fail(Outcome::crashed,
                    fmt::format("path planner '{}' stopped although no limit was reached and the run was not cancelled",
                                planner_id_));
        context.log(LogLevel::error, result.message);
      }
    }
  }
  if (is_success(result.outcome()) || result.outcome() == Outcome::crashed || computed.interrupted)
    result.state = nullptr;
  drop_nonsense(result, attempt);
  answer.seconds = seconds_since(begin) - answer.proof_seconds;
  return computed;
}

}  // namespace dismantle
