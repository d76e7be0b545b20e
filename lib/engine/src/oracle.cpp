#include "oracle.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "dismantle/part_set.h"
#include "stopwatch.h"

namespace dismantle {

namespace {

using Clock = std::chrono::steady_clock;

bool is_deeper(unsigned depth, unsigned than) { return than != 0 && (depth == 0 || depth > than); }

/// A search that ended for a reason other than its depth ends the same way with a larger depth. An outcome that needs
/// no search is the same at any depth.
bool holds_for_deeper(Outcome o) {
  return o == Outcome::exhausted || o == Outcome::infeasible || o == Outcome::timeout;
}
bool holds_for_all(Outcome o) {
  return o == Outcome::start_is_goal || o == Outcome::invalid_start || o == Outcome::unsupported;
}

void check(const PlanningSetup& setup) {
  if (!setup.simulator) throw std::invalid_argument("no simulator given");
  if (!setup.path_planner) throw std::invalid_argument("no path planner given");
}

}  // namespace

Oracle::Oracle(const Assembly& assembly, const PreparedAssembly& prepared, const PlanningSetup& setup,
               const DeferredSimulator* deferred, const RunOptions& options, const Verifier& verifier,
               const RunContext& context)
    : part_count_((check(setup), assembly.parts.size())),
      deferred_(deferred),
      verifier_(verifier),
      make_planner_(setup.path_planner),
      runner_(assembly, prepared, setup, deferred, options, verifier, context.rng),
      proofs_(assembly, verifier, setup.provers, options.proofs, context),
      forcing_(options.force == ForceWhen::off ? nullptr
                                               : std::make_unique<Forcing>(assembly, verifier, *this, options.proofs)),
      computed_ahead_(context.threads > 1 ? context.executor : nullptr, Executor::Priority::idle) {}

std::shared_ptr<PathPlanner> Oracle::borrow_planner() {
  const std::lock_guard lock(planner_mutex_);
  if (concurrent_planner_) return concurrent_planner_;
  if (!unused_planners_.empty()) {
    std::shared_ptr<PathPlanner> planner = std::move(unused_planners_.back());
    unused_planners_.pop_back();
    return planner;
  }
  std::shared_ptr<PathPlanner> planner = make_planner_();
  if (!planner) throw std::runtime_error("nothing was made");
  if (planner->traits().concurrent) concurrent_planner_ = planner;
  return planner;
}

void Oracle::give_back(std::shared_ptr<PathPlanner> planner) {
  const std::lock_guard lock(planner_mutex_);
  if (planner != concurrent_planner_) unused_planners_.push_back(std::move(planner));
}

/// Runs a search, unless a known proof answers the question. Proofs may be tried during the search, and after it if it
/// found no path. Time limits of the attempt begin with the search.
ComputedAttempt Oracle::run(PathPlanner& planner, const Question& question, const RunContext& context) {
  const Attempt& attempt = question.attempt;
  ComputedAttempt computed;
  computed.answer.certificate = proofs_.before(attempt);
  if (computed.answer.certificate != nullptr) {
    computed.answer.result = infeasible_by(*computed.answer.certificate, attempt);
  } else {
    // Parts that may not leave in some direction may leave in others: no proof says why no path was found.
    const bool provable = attempt.goal.without.empty();
    computed = runner_.run(planner, attempt, question.key, question.resumed,
                           provable ? proofs_.during(attempt, context) : std::vector<SearchPause>{}, context);
    const Clock::time_point begin = Clock::now();
    if (provable && !computed.interrupted && computed.answer.certificate == nullptr)
      computed.answer.certificate = proofs_.after(attempt, computed.answer.result, context);
    computed.answer.proof_seconds += seconds_since(begin);
    if (const Certificate* found = computed.answer.certificate; found != nullptr && found->full_tolerance) {
      PathResult& result = computed.answer.result;
      result.fail(Outcome::infeasible, found->text);
      result.blocked_by = infeasible_by(*found, attempt).blocked_by;
      result.state = nullptr;
    }
    // A proof that was cut short leaves the question open.
    if (computed.answer.certificate == nullptr && context.should_stop() &&
        !is_success(computed.answer.result.outcome()))
      computed.interrupted = true;
  }
  return computed;
}

/// Runs on any thread. Speculative computations have no log; they return their log lines.
LoggedAttempt Oracle::compute(const Question& question, RunContext context) {
  LoggedAttempt result;
  context.threads = 1;
  if (!context.on_log)
    context.on_log = [&result](LogLevel level, std::string_view text) {
      result.log.push_back({level, std::string(text)});
    };
  std::shared_ptr<PathPlanner> planner;
  std::string problem;
  try {
    planner = borrow_planner();
  } catch (const std::exception& e) {
    problem = e.what();
  } catch (...) {
    problem = "it threw something that is not a std::exception";
  }
  if (planner) {
    result.computed = run(*planner, question, context);
    give_back(std::move(planner));
    return result;
  }
  PathResult& crashed = result.computed.answer.result;
  crashed.fail(Outcome::crashed, fmt::format("path planner '{}' could not be made: {}", runner_.planner_id(), problem));
  context.log(LogLevel::error, crashed.message);
  return result;
}

const AttemptResult& Oracle::keep(AttemptResult result) { return results_.emplace_back(std::move(result)); }

const AttemptResult* Oracle::remembered(const AttemptKey& key) {
  if (const auto known = answers_.find(key); known != answers_.end()) return known->second;
  const auto known = finals_.find(key.scene);
  if (known == finals_.end()) return nullptr;
  const auto& [depth, answer] = known->second;
  if (!holds_for_all(answer->result.outcome()) && !is_deeper(key.max_depth, depth)) return nullptr;
  return answer;
}

/// The latest answer whose search one for `attempt` may resume.
const AttemptResult* Oracle::last_resumable(const Attempt& attempt) const {
  const auto known = unsuccessful_.find(digest_of_moving(attempt));
  if (known == unsuccessful_.end()) return nullptr;
  const auto last = std::find_if(known->second.rbegin(), known->second.rend(),
                                 [&](const AttemptResult* earlier) { return may_follow(attempt, earlier->attempt); });
  return last == known->second.rend() ? nullptr : *last;
}

/// A resumed search is a different question from one that begins anew. The same attempt asked for again has the same
/// answer.
Oracle::Question Oracle::question_of(const Attempt& attempt) const {
  Question question{canonical(attempt, part_count_), {}};
  question.key = {digest_of(question.attempt), attempt.max_depth, {}};
  if (!attempt.resume) return question;
  const AttemptResult* last = last_resumable(question.attempt);
  if (last == nullptr) return question;
  const AttemptKey& key = keys_.at(last);
  if (key.scene == question.key.scene && key.max_depth == question.key.max_depth) {
    question.key = key;
  } else if (last->result.state) {
    question.resumed = last;
    question.key.after = digest_of(key);
  }
  return question;
}

namespace {

/// The questions of several searches for the same, of which the best counts.
std::vector<Attempt> searches_of(const Attempt& attempt) {
  if (attempt.best_of == 0) throw std::invalid_argument("attempt for the best of no searches");
  std::vector<Attempt> searches(attempt.best_of, attempt);
  for (unsigned k = 0; k < attempt.best_of; ++k) {
    searches[k].best_of = 1;
    searches[k].seed = attempt.seed + k;
  }
  return searches;
}

}  // namespace

const AttemptResult& Oracle::best_of(const Attempt& attempt, RunContext& context) {
  const AttemptResult *best = nullptr, *first = nullptr;
  double shortest = 0;
  for (const Attempt& search : searches_of(attempt)) {
    const AttemptResult& answer = this->attempt(search, context);
    if (first == nullptr) first = &answer;
    if (answer.certificate != nullptr || answer.result.outcome() == Outcome::start_is_goal) return answer;
    if (!is_success(answer.result.outcome())) continue;
    const double length = runner_.length(answer);
    if (best == nullptr || length < shortest) best = &answer, shortest = length;
  }
  return best != nullptr ? *best : *first;
}

const AttemptResult& Oracle::attempt(const Attempt& attempt, RunContext& context) {
  if (attempt.best_of != 1) return best_of(attempt, context);
  const std::lock_guard lock(ask_mutex_);
  Question question = question_of(attempt);
  if (const AttemptResult* known = remembered(question.key)) {
    ++memoised_;
    return *known;
  }
  if (context.should_stop()) {
    AttemptResult stopped;
    stopped.attempt = std::move(question.attempt);
    stopped.result.fail(context.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout,
                        "not begun: the run was stopped");
    return keep(std::move(stopped));
  }
  const auto compute_it = [&](const RunContext& c) { return compute(question, c); };
  LoggedAttempt logged = computed_ahead_.get(question.key, compute_it, context);
  if (deferred_ != nullptr) deferred_->rethrow_failure();  // every other search would fail in the same way
  for (const auto& line : logged.log) context.log(line.level, line.text);
  ComputedAttempt& computed = logged.computed;
  if (!attempt.resume) computed.answer.result.state = nullptr;
  computed.answer.attempt = std::move(question.attempt);
  const AttemptResult& result = keep(std::move(computed.answer));
  for (const auto& [name, count] : result.result.stats.by_name()) planner_counts_[name] += count;
  if (computed.interrupted) return result;  // says nothing about the question: not remembered
  ++planned_;
  answers_.emplace(question.key, &result);
  keys_.emplace(&result, question.key);
  const Outcome outcome = result.result.outcome();
  if (holds_for_all(outcome) || holds_for_deeper(outcome))
    finals_.try_emplace(question.key.scene, Final{question.key.max_depth, &result});
  if (attempt.resume && !is_success(outcome)) unsuccessful_[digest_of_moving(result.attempt)].push_back(&result);
  return result;
}

void Oracle::prefetch(std::span<const Attempt> attempts, RunContext& context) {
  if (!computed_ahead_.computes_ahead() || context.should_stop()) return;
  std::deque<SpeculativeCache<AttemptKey, LoggedAttempt>::Sequence> wanted;
  const std::lock_guard lock(ask_mutex_);
  for (const Attempt& several : attempts)
    for (const Attempt& attempt : searches_of(several)) {
      Question question = question_of(attempt);
      if (remembered(question.key)) continue;
      const AttemptKey key = question.key;
      const auto compute_it = [this, question = std::move(question)](const RunContext& c) {
        return compute(question, c);
      };
      wanted.push_back({{key, compute_it}});
    }
  computed_ahead_.prefetch(std::move(wanted), context);
}

const AttemptResult& Oracle::propose(const Attempt& attempt, const Path& path, RunContext& context) {
  Attempt question = canonical(attempt, part_count_);
  if (ids_of(question.moving) != ids_of(attempt.moving))
    throw std::invalid_argument("a proposed path whose parts are not in ascending order");
  const std::lock_guard lock(ask_mutex_);
  ComputedAttempt computed;
  if (const Certificate* proof = attempt.goal.placement ? nullptr : proofs_.locked(attempt)) {
    computed.answer.certificate = proof;
    computed.answer.result = infeasible_by(*proof, attempt);
  } else {
    computed = runner_.check_proposal(attempt, path, context);
  }
  computed.answer.attempt = std::move(question);
  computed.answer.proposed = true;
  const AttemptResult& result = keep(std::move(computed.answer));
  if (computed.interrupted) return result;
  ++proposed_;
  if (is_success(result.result.outcome()))
    keys_.emplace(&result, AttemptKey{});
  else
    ++refused_;
  return result;
}

const AttemptResult& Oracle::keep_forced(AttemptResult answer) {
  const std::lock_guard lock(ask_mutex_);
  const AttemptResult& kept = keep(std::move(answer));
  keys_.emplace(&kept, AttemptKey{digest_of(kept.attempt), 0, {}});
  return kept;
}

void Oracle::recorded(const AttemptResult& answer) {
  const std::lock_guard lock(ask_mutex_);
  // The latest answers are recorded, so that the one in question is found at once.
  const auto own =
      std::find_if(results_.rbegin(), results_.rend(), [&](const AttemptResult& a) { return &a == &answer; });
  if (own == results_.rend() || emptied_.contains(&answer) ||
      std::find(recorded_.rbegin(), recorded_.rend(), &*own) != recorded_.rend())
    return;
  recorded_.push_back(&*own);
  kept_ += own->attempt.fixed.size();
  while (kept_ > most_kept_ && recorded_.size() > 1) {
    std::vector<PlacedPart>& fixed = recorded_.front()->attempt.fixed;
    emptied_.emplace(recorded_.front(), digest_of(std::span<const PlacedPart>(fixed)));
    kept_ -= fixed.size();
    std::vector<PlacedPart>().swap(fixed);  // an assignment would keep the memory
    recorded_.pop_front();
  }
}

bool Oracle::were_fixed(const AttemptResult& answer, std::span<const PartId> parts, std::span<const Pose> poses) const {
  if (const auto known = emptied_.find(&answer); known != emptied_.end())
    return known->second == digest_of(parts, poses);
  const std::vector<PlacedPart>& fixed = answer.attempt.fixed;
  return std::equal(parts.begin(), parts.end(), fixed.begin(), fixed.end(),
                    [&](PartId id, const PlacedPart& p) { return p.part == id && p.pose == poses[id]; });
}

OracleCounts Oracle::counts() const {
  OracleCounts counts;
  counts.attempts = planned_;
  counts.memoised = memoised_;
  counts.proposed = proposed_;
  counts.refused = refused_;
  counts.discarded = computed_ahead_.unused();
  return counts;
}

SearchEffort Oracle::effort_on(PartId part) const {
  SearchEffort effort;
  for (const AttemptResult& answer : results_) {  // in the order of asking
    const bool moves = contains(answer.attempt.moving, part);
    const auto key = keys_.find(&answer);
    if (!moves || key == keys_.end() || is_success(answer.result.outcome()) || !answers_.contains(key->second))
      continue;
    if (answer.certificate != nullptr && answer.seconds == 0) continue;  // proved without a search
    ++effort.attempts;
    effort.depth = std::max({effort.depth, answer.result.depth, answer.attempt.max_depth});
    effort.seconds += answer.seconds;
    effort.cost += answer.result.stats.cost;
  }
  return effort;
}

std::unique_ptr<PathOracle> make_oracle(const Assembly& assembly, const PreparedAssembly& prepared,
                                        const PlanningSetup& setup, const RunOptions& options, const Verifier& verifier,
                                        RunContext& context) {
  return std::make_unique<Oracle>(assembly, prepared, setup, nullptr, options, verifier, context);
}

}  // namespace dismantle
