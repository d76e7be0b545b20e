// Laws of the estimates, of the tree search, and of the planner on machines with known answers.
#include "mcts/mcts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "dismantle/testing/fake_oracle.h"

namespace dismantle {
namespace {

using mcts::Choice;
using mcts::Knowledge;
using mcts::UctSettings;

/// The first parts, as assembled.
std::vector<PlacedPart> group_of(std::size_t parts) {
  std::vector<PlacedPart> group;
  for (PartId id = 0; id < parts; ++id) group.push_back({id, Pose{}});
  return group;
}

TEST(Knowledge, ChancesGrowAsWhatWasInTheWayLeaves) {
  Rng rng(1);
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t parts = 3 + rng.below(10);
    Knowledge knowledge(parts, group_of(parts), 0);
    std::vector<PartId> blockers;
    for (PartId k = 1; k < parts; ++k)
      if (blockers.empty() || rng.below(2) == 0) blockers.push_back(k);
    knowledge.failed(0, rng.below(2) == 0 ? Outcome::exhausted : Outcome::depth_limit, blockers, 1 + rng.uniform());
    double last = -1;
    for (PartId k = 1; k < parts; ++k) {
      const double chance = knowledge.chance(0);
      EXPECT_GE(chance, last - 1e-12);
      EXPECT_LE(chance, 1);
      last = chance;
      const bool blocked = std::count(blockers.begin(), blockers.end(), k) != 0;
      knowledge.imagine_removal(k);
      if (blocked) {
        EXPECT_GT(knowledge.chance(0), chance);
      } else {
        EXPECT_EQ(knowledge.chance(0), chance);
      }
    }
    EXPECT_DOUBLE_EQ(knowledge.chance(0), 1.0 / 3) << "of one question none was a success";
  }
}

TEST(Knowledge, TheSameQuestionIsNotOpenTwice) {
  Knowledge knowledge(3, group_of(3), 2);
  EXPECT_EQ(knowledge.open(), (std::vector<PartId>{0, 1, 2}));
  knowledge.failed(1, Outcome::exhausted, {0}, 1);
  EXPECT_EQ(knowledge.open(), (std::vector<PartId>{0, 2}));
  knowledge.failed(2, Outcome::depth_limit, {0}, 1);
  EXPECT_EQ(knowledge.open(), (std::vector<PartId>{0, 2})) << "a deeper search is another question";
  EXPECT_EQ(knowledge[2].depth, 2u);
  knowledge.failed(2, Outcome::depth_limit, {0}, 2);
  EXPECT_EQ(knowledge.open(), (std::vector<PartId>{0})) << "as deep as is allowed";
  knowledge.removed(0, 1);
  EXPECT_EQ(knowledge.open(), (std::vector<PartId>{1, 2}));
  EXPECT_EQ(knowledge.left(), 2u);
}

TEST(Uct, SpendsAllSimulationsAndDependsOnTheSeedAlone) {
  Rng machines(2);
  for (int trial = 0; trial < 40; ++trial) {
    const std::size_t parts = 2 + machines.below(12);
    const Knowledge knowledge(parts, group_of(parts), 0);
    UctSettings settings;
    settings.simulations = static_cast<std::int64_t>(1 + machines.below(300));
    Rng a(7), b(7);
    const auto first = mcts::choose(knowledge, settings, a), again = mcts::choose(knowledge, settings, b);
    ASSERT_EQ(first.size(), parts);
    std::uint64_t visits = 0;
    for (std::size_t k = 0; k < parts; ++k) {
      visits += first[k].visits;
      EXPECT_EQ(first[k].part, again[k].part);
      EXPECT_EQ(first[k].visits, again[k].visits);
      EXPECT_EQ(first[k].value, again[k].value);
      EXPECT_GE(first[k].value, 0);
      EXPECT_LE(first[k].value, 1);
      if (k > 0) {
        EXPECT_LE(first[k].visits, first[k - 1].visits);
      }
    }
    EXPECT_EQ(visits, static_cast<std::uint64_t>(settings.simulations));
  }
}

/// A run in which most questions were successes, each at cost 10: parts from `first` on have left.
Knowledge after_successes(PartId first) {
  Knowledge knowledge(first + 20, group_of(first + 20), 0);
  for (PartId k = first; k < first + 20; ++k) knowledge.removed(k, 10);
  return knowledge;
}

TEST(Uct, PrefersWhatIsInTheWayOfOthers) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Rng rng(seed);
    const auto key = static_cast<PartId>(rng.below(6));
    Knowledge knowledge = after_successes(6);
    for (PartId k = 0; k < 6; ++k)
      if (k != key) knowledge.failed(k, Outcome::depth_limit, {key}, 10);
    UctSettings settings;
    settings.simulations = 1000;
    EXPECT_EQ(mcts::choose(knowledge, settings, rng).front().part, key);
  }
}

TEST(Uct, PrefersCheapSearches) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Rng rng(seed);
    const auto cheap = static_cast<PartId>(rng.below(4));
    Knowledge knowledge = after_successes(5);
    for (PartId k = 0; k < 4; ++k) knowledge.failed(k, Outcome::depth_limit, {4}, k == cheap ? 1 : 60);
    knowledge.failed(4, Outcome::exhausted, {0}, 10);
    UctSettings settings;
    settings.simulations = 1000;
    EXPECT_EQ(mcts::choose(knowledge, settings, rng).front().part, cheap);
  }
}

TEST(Mcts, SolvesEveryMachineThatHasAnOrder) {
  Rng rng(3);
  for (int trial = 0; trial < 150; ++trial) {
    const FakeMachine machine = FakeMachine::random(1 + rng.below(14), rng.uniform(), 4, rng);
    Mcts planner(MctsParameters{});
    const FakeRun run = run_on(planner, machine, seeded(static_cast<std::uint64_t>(trial)));
    expect_lawful(run, machine);
    EXPECT_EQ(run.result.outcome, Outcome::solved);
  }
}

/// Simulations save searches: with one simulation for each decision, which is random choice, more are made.
TEST(Mcts, MoreSimulationsFewerSearches) {
  std::size_t searches[2] = {0, 0};
  Rng rng(4);
  for (int trial = 0; trial < 60; ++trial) {
    const FakeMachine machine = FakeMachine::random(12, 0.4, 1, rng);
    for (const int many : {0, 1}) {
      MctsParameters params;
      params.simulations = many == 1 ? 300 : 1;
      Mcts planner(params);
      searches[many] += run_on(planner, machine, seeded(static_cast<std::uint64_t>(trial))).asked.size();
    }
  }
  EXPECT_LT(searches[1], searches[0]);
}

TEST(Mcts, KeepsToItsSearches) {
  Rng rng(5);
  for (std::int64_t most = 1; most < 20; ++most) {
    const FakeMachine machine = FakeMachine::random(12, 0.4, 3, rng);
    MctsParameters params;
    params.max_attempts = most;
    Mcts planner(params);
    const FakeRun run = run_on(planner, machine, seeded(1));
    expect_lawful(run, machine);
    EXPECT_LE(run.asked.size(), static_cast<std::size_t>(most));
    if (most < 11) {
      EXPECT_NE(run.result.outcome, Outcome::solved);
      EXPECT_EQ(run.asked.size(), static_cast<std::size_t>(most));
    }
  }
}

TEST(Mcts, ParametersAreDeclaredInFull) { EXPECT_TRUE(problems_of_schema(Schema<MctsParameters>().specs()).empty()); }

}  // namespace
}  // namespace dismantle
