#include "chain/chain.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "dismantle/part_set.h"

namespace dismantle {

void ChainParameters::describe(Schema<ChainParameters>& s) {
  s.add(
      "of", &ChainParameters::of,
      {.doc = "The planners, in order. After the last: `least_cut`, to take out what no verified path is known for."});
  s.add("later_share", &ChainParameters::later_share,
        {.unit = "1",
         .min = 0,
         .max = 0.9,
         .doc = "Share of the time until run.timeout that is kept for the planners after the first. With run.force: "
                "last_resort each remaining part gets its step in this time; with more time the steps cut in less."});
  s.advanced("retry_share", &ChainParameters::retry_share, {.min = 0, .max = 0.9});
  s.advanced("retry_depth", &ChainParameters::retry_depth, {.min = 1, .max = 1000});
}

namespace {

/// Another oracle, with a limit of the depth of its searches.
class ShallowOracle final : public PathOracle {
 public:
  ShallowOracle(PathOracle& oracle, unsigned depth) : oracle_(oracle), depth_(depth) {}
  const AttemptResult& attempt(const Attempt& attempt, RunContext& context) override {
    return oracle_.attempt(limited(attempt), context);
  }
  void prefetch(std::span<const Attempt> attempts, RunContext& context) override {
    std::vector<Attempt> all;
    for (const Attempt& attempt : attempts) all.push_back(limited(attempt));
    oracle_.prefetch(all, context);
  }
  const AttemptResult& propose(const Attempt& attempt, const Path& path, RunContext& context) override {
    return oracle_.propose(attempt, path, context);
  }
  OracleCounts counts() const override { return oracle_.counts(); }
  const Certificate* prove(const SeparationQuestion& question, const RunContext& context) override {
    return oracle_.prove(question, context);
  }
  double tolerance() const override { return oracle_.tolerance(); }
  PartMemo* memo() override { return oracle_.memo(); }
  ForcingOracle* forcing() override { return oracle_.forcing(); }

 private:
  Attempt limited(Attempt attempt) const {
    attempt.max_depth = attempt.max_depth == 0 ? depth_ : std::min(attempt.max_depth, depth_);
    return attempt;
  }
  PathOracle& oracle_;
  unsigned depth_;
};

/// Runs the planners and keeps the disassembly up to date.
class Links final : public SequenceObserver {
 public:
  Links(const ChainParameters& params, const std::vector<std::shared_ptr<SequencePlanner>>& planners,
        const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer, RunContext& context)
      : params_(params),
        planners_(planners),
        query_(query),
        oracle_(oracle),
        observer_(observer),
        context_(context),
        disassembly_(query.assembly.parts.size(), query.start),
        said_(query.said.begin(), query.said.end()) {}

  void removed(const Removal& removal, std::size_t parts_left) override {
    Removal named = removal;
    if (named.planner.empty()) named.planner = params_.of[running_].type();
    observer_.removed(named, parts_left);
    disassembly_.add(step_of(removal));
    all_.removals.push_back(std::move(named));
  }

  bool taken_back(std::size_t count) override {
    if (count > all_.removals.size() || !observer_.taken_back(count)) return false;
    for (; count > 0; --count) {
      disassembly_.pop();
      all_.removals.pop_back();
    }
    return true;
  }

  SequenceResult run() {
    link(0, query_.start, oracle_, time_of_first());
    if (failed()) return finish();  // what a planner did wrong is not hidden by those after it
    for (const auto& group : open()) tried_.insert(ids_of(group));
    for (std::size_t k = 1; k < planners_.size();) {
      if (context_.cancel.cancelled() || open().empty()) break;
      const std::size_t before = disassembly_.steps().size();
      link(k, open(), oracle_, context_.deadline);
      if (disassembly_.steps().size() == before) {
        ++k;
      } else {
        retry(k);
        k = 1;
      }
    }
    return finish();
  }

 private:
  std::vector<std::vector<PlacedPart>> open() const { return open_groups(disassembly_, query_.constraints); }

  Deadline time_of_first() const {
    const double left = context_.deadline.seconds_left();
    const bool forces = oracle_.forcing() != nullptr;
    const bool others = std::any_of(planners_.begin() + 1, planners_.end(),
                                    [&](const auto& planner) { return forces || !planner->traits().forces; });
    if (!std::isfinite(left) || !others) return context_.deadline;
    return Deadline::after_seconds((1 - params_.later_share) * left);
  }

  /// Runs planner `k` on these groups and keeps what it says.
  void link(std::size_t k, const std::vector<std::vector<PlacedPart>>& groups, PathOracle& oracle,
            const Deadline& deadline) {
    RunContext own = context_;
    own.deadline = deadline;
    own.rng = k == 0 ? context_.rng : context_.rng.fork(k);
    running_ = k;
    const SequenceQuery query{query_.assembly, groups, query_.constraints, query_.objective, said_};
    const SequenceResult result = planners_[k]->plan(query, oracle, *this, own);
    if (!first_done_) all_.outcome = result.outcome;
    first_done_ = true;
    for (const auto& [name, count] : result.counts) all_.counts[name] += count;
    for (const Certificate* proof : result.proofs) state(proof);
    for (const Unsolved& u : result.unsolved) {
      state(u.certificate);
      const auto known =
          std::find_if(said_.begin(), said_.end(), [&](const Unsolved& earlier) { return earlier.part == u.part; });
      if (known == said_.end())
        said_.push_back(u);
      else if (known->certificate == nullptr || u.certificate != nullptr)
        *known = u;
    }
  }

  /// Has the first planner crashed, or claimed a success that is none?
  bool failed() {
    if (is_success(all_.outcome) && !open().empty()) {
      context_.log(LogLevel::error, "the sequence planner '" + params_.of.front().type() +
                                        "' reports success with parts still together");
      all_.outcome = Outcome::crashed;
    }
    return all_.outcome == Outcome::crashed;
  }

  /// Gives the groups that planner `k` has made to those before it.
  void retry(std::size_t k) {
    ShallowOracle shallow(oracle_, params_.retry_depth);
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      if (!planners_[earlier]->traits().any_start) continue;
      for (const std::vector<PlacedPart>& group : open()) {
        const Deadline deadline = time_of_retry();
        if (deadline.passed() || context_.cancel.cancelled()) return;
        if (earlier == 0 && !tried_.insert(ids_of(group)).second) continue;
        link(earlier, {group}, shallow, deadline);
      }
    }
  }

  /// An equal share for each step that is left, but at least `retry_share`.
  Deadline time_of_retry() const {
    const double left = context_.deadline.seconds_left();
    if (!std::isfinite(left)) return context_.deadline;
    std::size_t steps = 1;
    for (const auto& group : open()) steps += group.size() - 1;
    return Deadline::after_seconds(std::max(params_.retry_share, 1.0 / static_cast<double>(steps)) * left);
  }

  void state(const Certificate* proof) {
    if (proof != nullptr && std::find(all_.proofs.begin(), all_.proofs.end(), proof) == all_.proofs.end())
      all_.proofs.push_back(proof);
  }

  SequenceResult finish() {
    const std::vector<std::vector<PlacedPart>> left = open();
    for (const std::vector<PartId>& group : disassembly_.groups())
      if (&group == &disassembly_.groups().front() || group.size() > 1)
        all_.remaining.insert(all_.remaining.end(), group.begin(), group.end());
    const bool forced = std::any_of(all_.removals.begin(), all_.removals.end(),
                                    [](const Removal& removal) { return removal.attempt->forced != nullptr; });
    if (left.empty() && !forced) all_.outcome = Outcome::solved;
    if (!left.empty() && is_success(all_.outcome)) all_.outcome = Outcome::exhausted;
    if (!left.empty() && context_.cancel.cancelled() && all_.outcome != Outcome::crashed)
      all_.outcome = Outcome::cancelled;
    for (const Unsolved& u : said_)
      if (std::any_of(left.begin(), left.end(), [&](const auto& group) { return contains(group, u.part); }))
        all_.unsolved.push_back(u);
    return all_;
  }

  const ChainParameters& params_;
  const std::vector<std::shared_ptr<SequencePlanner>>& planners_;
  const SequenceQuery& query_;
  PathOracle& oracle_;
  SequenceObserver& observer_;
  RunContext& context_;
  Disassembly disassembly_;
  std::vector<Unsolved> said_;           // the latest of each part; one with a proof stays
  std::set<std::vector<PartId>> tried_;  // groups that the first planner was given
  std::size_t running_ = 0;
  bool first_done_ = false;  // the first planner, on the whole start
  SequenceResult all_;
};

}  // namespace

Chain::Chain(const ChainParameters& params) : params_(params), traits_{true, true, true, false} {
  if (params_.of.empty()) throw std::invalid_argument("a chain has at least one planner");
  for (const auto& ref : params_.of) {
    const auto planner = planners_.emplace_back(ref.create());
    const SequencePlannerTraits one = planner->traits();
    if (planners_.size() > 1 && !one.any_start)
      throw std::invalid_argument("'" + ref.type() + "' can only be the first of a chain: it starts from no other " +
                                  "arrangement than the assembled one");
    if (planners_.size() == 1) traits_.any_start = one.any_start;
    traits_.keeps_constraints = traits_.keeps_constraints && one.keeps_constraints;
    // What is forced has no choice between removals.
    traits_.follows_objective = traits_.follows_objective && (one.follows_objective || one.forces);
  }
}

SequenceResult Chain::plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                           RunContext& context) {
  return Links(params_, planners_, query, oracle, observer, context).run();
}

}  // namespace dismantle
