// Planners one after the other: each starts from what those before it have left.
#include "chain/chain.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

#include "dismantle/testing/run_rig.h"

namespace dismantle {
namespace {

/// Removes at most `most` parts, and records what it was asked.
class Some final : public SequencePlanner {
 public:
  Some(std::size_t most, bool any_start) : most_(most), any_start_(any_start) {}
  SequencePlannerTraits traits() const noexcept override { return {.any_start = any_start_}; }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override {
    SequenceResult result;
    result.outcome = Outcome::exhausted;
    for (const auto& group : query.start) {
      asked.push_back(ids_of(group));
      std::vector<PlacedPart> left = group;
      for (std::size_t i = 0; i < left.size() && left.size() > 1 && result.removals.size() < most_;) {
        const AttemptResult& answer = oracle.attempt(fake::InTurn::question(left, left[i]), context);
        depths.insert(answer.attempt.max_depth);
        if (!is_success(answer.result.outcome())) {
          ++i;
          continue;
        }
        result.removals.push_back({{left[i].part}, &answer});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
        observer.removed(result.removals.back(), left.size());
        i = 0;
      }
      for (const PlacedPart& p : left) result.unsolved.push_back({p.part, Outcome::exhausted, {}, {}, "had enough"});
    }
    return result;
  }
  std::vector<std::vector<PartId>> asked;
  std::set<unsigned> depths;

 private:
  std::size_t most_;
  bool any_start_;
};

PluginRef<SequencePlanner> ref_to(const std::shared_ptr<SequencePlanner>& planner) {
  return {PluginChoice{"some", {}, {}},
          [planner](PluginKind, const PluginChoice&) -> std::shared_ptr<void> { return planner; }};
}

RunResult run_chain(const Assembly& assembly, const std::vector<std::shared_ptr<SequencePlanner>>& planners) {
  ChainParameters params;
  for (const auto& planner : planners) params.of.push_back(ref_to(planner));
  RunContext context;
  return run(assembly, fake::setup(fake::push, std::make_shared<Chain>(params)), {}, context);
}

TEST(Chain, ALaterPlannerGetsWhatIsLeft) {
  const auto first = std::make_shared<Some>(1, true), second = std::make_shared<Some>(1, true);
  const RunResult r = run_chain(fake::row(4), {first, second});
  EXPECT_EQ(r.outcome, Outcome::solved);
  EXPECT_EQ(r.plan.status, PlanStatus::complete);
  EXPECT_TRUE(r.plan.unsolved.empty());
  ASSERT_EQ(first->asked.size(), 2u) << "what the second one has made is given to the first again";
  EXPECT_EQ(first->asked.front().size(), 4u);
  EXPECT_EQ(first->asked.back().size(), 2u);
  ASSERT_EQ(second->asked.size(), 1u);
  EXPECT_EQ(second->asked.front().size(), 3u);
  EXPECT_TRUE(first->depths.contains(0)) << "its first searches have no limit";
  EXPECT_TRUE(first->depths.contains(ChainParameters{}.retry_depth)) << "those of later groups are shallow";
}

TEST(Chain, OneThatNeedsTheWholeAssemblyIsOnlyAskedOnce) {
  const auto first = std::make_shared<Some>(1, false), second = std::make_shared<Some>(1, true);
  const RunResult r = run_chain(fake::row(4), {first, second});
  EXPECT_EQ(r.outcome, Outcome::solved);
  EXPECT_EQ(first->asked.size(), 1u);
  EXPECT_EQ(second->asked.size(), 2u);
  EXPECT_THROW(run_chain(fake::row(3), {second, first}), std::invalid_argument);
}

TEST(Chain, HasAtLeastOnePlanner) { EXPECT_THROW(Chain(ChainParameters{}), std::invalid_argument); }

/// The planners after the first must not hide what it did wrong.
TEST(Chain, AClaimOfSuccessThatIsNoneEndsTheRun) {
  class Claims final : public SequencePlanner {
   public:
    SequencePlannerTraits traits() const noexcept override { return {.any_start = true}; }
    SequenceResult plan(const SequenceQuery&, PathOracle&, SequenceObserver&, RunContext&) override {
      SequenceResult result;
      result.outcome = Outcome::solved;
      return result;
    }
  };
  const auto second = std::make_shared<Some>(9, true);
  const RunResult r = run_chain(fake::row(3), {std::make_shared<Claims>(), second});
  EXPECT_EQ(r.outcome, Outcome::crashed);
  EXPECT_TRUE(second->asked.empty());
}

TEST(Chain, ReasonsAreTheLatestAndOnlyOfPartsThatAreLeft) {
  const auto first = std::make_shared<Some>(1, true), second = std::make_shared<Some>(0, true);
  const RunResult r = run_chain(fake::row(4), {first, second});
  EXPECT_EQ(r.outcome, Outcome::exhausted);
  EXPECT_EQ(r.plan.status, PlanStatus::partial);
  ASSERT_EQ(r.plan.unsolved.size(), 3u);
  for (const PlanUnsolved& u : r.plan.unsolved) EXPECT_EQ(u.message, "had enough");
}

}  // namespace
}  // namespace dismantle
