/// The oracle that `run` uses, with queries beyond the interface.
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "attempt_runner.h"
#include "dismantle/speculative_cache.h"
#include "forcing.h"
#include "proof_schedule.h"

namespace dismantle {

struct LogLine {
  LogLevel level = LogLevel::info;
  std::string text;
};

/// An attempt that was computed, perhaps before it was asked for.
struct LoggedAttempt {
  ComputedAttempt computed;
  std::vector<LogLine> log;  ///< passed on by the asking thread; empty if the attempt had its own log
};

/// Total cost of several searches.
struct SearchEffort {
  unsigned attempts = 0;
  unsigned depth = 0;  ///< the largest depth that was allowed; 0: none of them had a limit
  double seconds = 0;
  double cost = 0;  ///< as SearchStats::cost: the same on every machine
};

class Oracle final : public PathOracle {
 public:
  Oracle(const Assembly& assembly, const PreparedAssembly& prepared, const PlanningSetup& setup,
         const DeferredSimulator* deferred, const RunOptions& options, const Verifier& verifier,
         const RunContext& context);

  const AttemptResult& attempt(const Attempt& attempt, RunContext& context) override;
  void prefetch(std::span<const Attempt> attempts, RunContext& context) override;
  const AttemptResult& propose(const Attempt& attempt, const Path& path, RunContext& context) override;
  OracleCounts counts() const override;
  const Certificate* prove(const SeparationQuestion& question, const RunContext& context) override {
    return proofs_.prove(question, context);
  }
  PartMemo* memo() override { return &proofs_.memo(); }
  double tolerance() const override { return verifier_.options().max_penetration; }
  ForcingOracle* forcing() override { return forcing_.get(); }

  /// Has this oracle planned it, remembered it, or accepted it as a proposal?
  bool answered(const AttemptResult* result) const { return keys_.contains(result); }
  /// Cost of the unsuccessful searches for removing `part`, alone or with others, that were asked for and not
  /// interrupted.
  SearchEffort effort_on(PartId part) const;
  const std::string& planner_id() const { return runner_.planner_id(); }
  /// Keeps an answer with a forced removal; its question is canonical.
  const AttemptResult& keep_forced(AttemptResult answer);
  /// To be called when the answer has been recorded as a step. Each answer lists all parts that stay, which is half of
  /// the square of the parts in all: beyond keep_at_most(), `attempt.fixed` of the oldest recorded answers is
  /// emptied. Nothing else is forgotten.
  void recorded(const AttemptResult& answer);
  /// Were exactly these parts fixed in the question, at these poses (by part, canonical)? Also for emptied lists.
  bool were_fixed(const AttemptResult& answer, std::span<const PartId> parts, std::span<const Pose> poses) const;
  void keep_at_most(std::size_t placed_parts) { most_kept_ = placed_parts; }
  std::size_t kept() const { return kept_; }  ///< such parts now
  /// Proofs that parts cannot be separated.
  ProofSchedule& proofs() { return proofs_; }
  /// As ProofSchedule::seconds.
  double proof_seconds() const { return proofs_.seconds(); }
  /// PathResult::stats by name, summed over the answers that were asked for, in the order of asking; interrupted ones
  /// included.
  const std::map<std::string, double>& planner_counts() const { return planner_counts_; }

 private:
  struct Final {
    unsigned max_depth = 0;
    const AttemptResult* answer = nullptr;
  };
  struct Question {
    Attempt attempt;  ///< canonical
    AttemptKey key;
    const AttemptResult* resumed = nullptr;  ///< the answer of the search that this one resumes
  };
  const AttemptResult& best_of(const Attempt& attempt, RunContext& context);
  Question question_of(const Attempt& attempt) const;
  const AttemptResult* last_resumable(const Attempt& canonical_attempt) const;
  const AttemptResult* remembered(const AttemptKey& key);
  LoggedAttempt compute(const Question& question, RunContext context);
  ComputedAttempt run(PathPlanner& planner, const Question& question, const RunContext& context);
  std::shared_ptr<PathPlanner> borrow_planner();
  void give_back(std::shared_ptr<PathPlanner> planner);
  const AttemptResult& keep(AttemptResult result);

  std::size_t part_count_;
  const DeferredSimulator* deferred_;
  const Verifier& verifier_;
  std::function<std::shared_ptr<PathPlanner>()> make_planner_;
  AttemptRunner runner_;
  ProofSchedule proofs_;
  std::unique_ptr<Forcing> forcing_;  ///< null: no step is forced
  std::mutex ask_mutex_;              ///< one question at a time
  std::deque<AttemptResult> results_;
  std::deque<AttemptResult*> recorded_;           ///< whose lists of fixed parts are kept, the oldest first
  std::size_t kept_ = 0;                          ///< fixed parts in them
  std::size_t most_kept_ = std::size_t{1} << 22;  ///< about 300 MiB; the first 2800 steps of a plan have fewer
  std::map<const AttemptResult*, PlacesDigest> emptied_;
  std::map<AttemptKey, const AttemptResult*> answers_;
  std::map<SceneDigest, Final> finals_;
  std::map<const AttemptResult*, AttemptKey> keys_;  ///< of what can be recorded; proposals are not asked by key
  std::map<SceneDigest, std::vector<const AttemptResult*>> unsuccessful_;  ///< by digest_of_moving, in order of asking
  std::map<std::string, double> planner_counts_;
  std::atomic<std::uint64_t> planned_{0}, memoised_{0}, proposed_{0}, refused_{0};
  std::mutex planner_mutex_;                         ///< the factory need not be safe to call from several threads
  std::shared_ptr<PathPlanner> concurrent_planner_;  ///< serves all attempts; null if planners are not concurrent
  std::vector<std::shared_ptr<PathPlanner>> unused_planners_;   ///< each serves one attempt at a time
  SpeculativeCache<AttemptKey, LoggedAttempt> computed_ahead_;  ///< last: its tasks use all of the above
};

}  // namespace dismantle
