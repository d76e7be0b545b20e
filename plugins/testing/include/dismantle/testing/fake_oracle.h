/// An oracle without geometry for tests of sequence planners: a part leaves when its blocking parts are gone and the
/// search is deep enough.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/sequence_planner.h"
#include "dismantle/testing/path_checking.h"

namespace dismantle {

/// The precedence of parts, and the number of actions of each removal.
struct FakeMachine {
  std::vector<std::vector<PartId>> before;  ///< by part: the parts that block it
  std::vector<unsigned> depth;              ///< by part, >= 1
  std::vector<double> volume;

  explicit FakeMachine(std::size_t parts) : before(parts), depth(parts, 1), volume(parts, 1.0) {}
  std::size_t size() const { return before.size(); }

  /// Part order[k] is blocked only by earlier ones in a random order, which is therefore valid.
  static FakeMachine random(std::size_t parts, double density, unsigned max_depth, Rng& rng) {
    FakeMachine machine(parts);
    std::vector<PartId> order;
    for (std::size_t i = 0; i < parts; ++i) order.push_back(static_cast<PartId>(i));
    for (std::size_t n = parts; n > 1; --n) std::swap(order[n - 1], order[rng.below(n)]);
    for (std::size_t k = 0; k < parts; ++k) {
      machine.depth[k] = 1 + static_cast<unsigned>(rng.below(max_depth));
      machine.volume[k] = rng.uniform(0.1, 10.0);
      for (std::size_t j = 0; j < k; ++j)
        if (rng.uniform() < density) machine.before[order[k]].push_back(order[j]);
    }
    return machine;
  }

  Assembly assembly() const {
    Assembly a;
    for (std::size_t i = 0; i < size(); ++i) {
      Part part;
      part.id = static_cast<PartId>(i);
      part.name = "part" + std::to_string(i);
      part.mesh = part.surface = std::make_shared<Mesh>();
      part.volume = volume[i];
      a.parts.push_back(std::move(part));
    }
    return a;
  }
};

/// An oracle that answers from a FakeMachine, records the questions and checks that the planner keeps the rules.
class FakeOracle final : public PathOracle {
 public:
  explicit FakeOracle(FakeMachine machine) : machine_(std::move(machine)) {}

  const AttemptResult& attempt(const Attempt& a, RunContext& context) override {
    asked.push_back({a.moving.at(0).part, a.max_depth});
    questions.push_back(a);
    if (on_attempt) on_attempt(asked.size());
    results_.emplace_back();
    PathResult& r = results_.back().result;
    if (context.should_stop()) {
      r.fail(Outcome::cancelled);
      return results_.back();
    }
    const PartId part = a.moving.at(0).part;
    for (const auto& fixed : a.fixed)
      if (std::count(machine_.before[part].begin(), machine_.before[part].end(), fixed.part) != 0)
        r.blocked_by.push_back(fixed.part);
    const bool deep_enough = a.max_depth == 0 || a.max_depth >= machine_.depth[part];
    if (!deep_enough) {
      r.fail(Outcome::depth_limit);
      r.state = std::make_shared<SearchState>();
    } else if (!r.blocked_by.empty()) {
      r.fail(Outcome::exhausted, "blocked");
      r.state = std::make_shared<SearchState>();
      r.best_pose = {Pose{{0.5, 0, 0}, Eigen::Quaterniond::Identity()}};
    } else {
      r.solve(fake::accept_all().verified({{Pose{}}, {Pose{{100, 0, 0}, Eigen::Quaterniond::Identity()}}}),
              machine_.depth[part]);
    }
    ++counts_.attempts;
    answers.push_back(&results_.back());
    return results_.back();
  }
  void prefetch(std::span<const Attempt> attempts, RunContext&) override { hinted += attempts.size(); }
  const AttemptResult& propose(const Attempt&, const Path&, RunContext&) override {
    results_.emplace_back();
    results_.back().result.fail(Outcome::exhausted);
    return results_.back();
  }
  OracleCounts counts() const override { return counts_; }

  std::vector<std::pair<PartId, unsigned>> asked;
  std::vector<Attempt> questions;             ///< the same attempts in full
  std::vector<const AttemptResult*> answers;  ///< by question
  std::size_t hinted = 0;
  std::function<void(std::size_t)> on_attempt;

 private:
  FakeMachine machine_;
  std::deque<AttemptResult> results_;
  OracleCounts counts_;
};

/// Records the reported removals and the numbers of parts left.
class Notes final : public SequenceObserver {
 public:
  void removed(const Removal& removal, std::size_t parts_left) override {
    order.push_back(removal.parts.at(0));
    left.push_back(parts_left);
  }
  std::vector<PartId> order;
  std::vector<std::size_t> left;
};

/// The run of a sequence planner on a FakeOracle.
struct FakeRun {
  SequenceResult result;
  Notes notes;
  std::vector<std::pair<PartId, unsigned>> asked;
};

/// Runs the planner on a FakeOracle of the machine; `on_attempt` is called with the number of each attempt.
inline FakeRun run_on(SequencePlanner& planner, const FakeMachine& machine, RunContext context,
                      std::function<void(std::size_t)> on_attempt = {}) {
  FakeRun run;
  FakeOracle oracle(machine);
  oracle.on_attempt = std::move(on_attempt);
  const Assembly assembly = machine.assembly();
  const Constraints constraints;
  const Objective objective;
  run.result = planner.plan({assembly, whole_assembly(assembly), constraints, objective}, oracle, run.notes, context);
  for (auto& removal : run.result.removals) removal.attempt = nullptr;  // attempts end with the oracle
  run.asked = oracle.asked;
  return run;
}

/// A context with this random seed.
inline RunContext seeded(std::uint64_t seed) {
  RunContext context;
  context.rng = Rng(seed);
  return context;
}

/// Laws of every result: removed and remaining parts are all parts, removals were reported in order, no part left
/// before its blockers, and every remaining part has a reason.
inline void expect_lawful(const FakeRun& run, const FakeMachine& machine) {
  std::vector<bool> gone(machine.size(), false);
  std::vector<PartId> order;
  for (const auto& removal : run.result.removals) {
    ASSERT_EQ(removal.parts.size(), 1u);
    const PartId part = removal.parts[0];
    ASSERT_LT(part, machine.size());
    EXPECT_FALSE(gone[part]) << "part " << part << " left twice";
    for (const PartId b : machine.before[part]) EXPECT_TRUE(gone[b]) << part << " left before " << b;
    gone[part] = true;
    order.push_back(part);
  }
  EXPECT_EQ(order, run.notes.order);
  for (std::size_t i = 0; i < run.notes.left.size(); ++i) EXPECT_EQ(run.notes.left[i], machine.size() - 1 - i);
  EXPECT_EQ(order.size() + run.result.remaining.size(), machine.size());
  for (const PartId id : run.result.remaining) EXPECT_FALSE(gone[id]);
  if (run.result.outcome == Outcome::solved) {
    EXPECT_LE(run.result.remaining.size(), 1u);
    EXPECT_TRUE(run.result.unsolved.empty());
  } else {
    EXPECT_GT(run.result.remaining.size(), 1u);
    std::vector<PartId> explained;
    for (const auto& u : run.result.unsolved) {
      explained.push_back(u.part);
      EXPECT_FALSE(is_success(u.outcome));
      for (const PartId b : u.blocked_by) EXPECT_FALSE(gone[b]);
    }
    std::vector<PartId> remaining = run.result.remaining;
    std::sort(remaining.begin(), remaining.end());
    std::sort(explained.begin(), explained.end());
    EXPECT_EQ(explained, remaining);
  }
}

}  // namespace dismantle
