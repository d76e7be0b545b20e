// When provers are asked, and how an answer affects an attempt.
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "dismantle/run_context.h"
#include "dismantle/testing/fake_prover.h"
#include "dismantle/testing/oracle_rig.h"
#include "dismantle/testing/run_rig.h"

namespace dismantle {
namespace {

using fake::claim;
using fake::leave;
using fake::outcome;
using fake::Rig;
using fake::row;

constexpr ProverTraits kTrivial{ProofEffort::trivial, 2, 2, false}, kLow{ProofEffort::low, 2, 2, false},
    kMedium{ProofEffort::medium, 2, 2, false}, kHigh{ProofEffort::high, 2, 2, false},
    kGroups{ProofEffort::high, 3, 4, false}, kPlaced{ProofEffort::low, 2, 100, true};

/// Counts what it is asked, and proves it or not.
struct Asked {
  bool proves = true;
  std::vector<std::vector<PartId>> parts;
  std::vector<double> shares;

  NamedProver prover(const std::string& id, const ProverTraits& traits) {
    return fake::prover(id, traits, [this](const SeparationQuery& q, const RunContext&) -> std::optional<Certificate> {
      parts.push_back(claim(q).parts);
      shares.push_back(q.share);
      return proves ? std::optional(claim(q)) : std::nullopt;
    });
  }
};

/// A search that touches `blocker`, and finds nothing.
auto touching(std::vector<PartId> blocked_by, int& searches, Outcome o = Outcome::depth_limit) {
  return [blocked_by, &searches, o](const PathQuery&, RunContext&) {
    ++searches;
    PathResult r = outcome(o);
    r.blocked_by = blocked_by;
    return r;
  };
}

PlanningSetup with(PlanningSetup setup, std::vector<NamedProver> provers) {
  setup.provers = std::move(provers);
  return setup;
}

TEST(ProofSchedule, LocksOfOverlapsEndEveryAttemptAndProposal) {
  Asked lock;
  int searches = 0;
  Assembly assembly = row(3);
  assembly.overlaps = {{0, 1, 0.1}};
  Rig s(assembly, with(fake::setup(touching({}, searches)), {lock.prover("lock", kTrivial)}));
  EXPECT_EQ(lock.parts, (std::vector<std::vector<PartId>>{{0, 1}})) << "pairs that do not overlap are not asked about";
  for (const unsigned depth : {0U, 1U, 7U}) {
    const AttemptResult& r = s.ask(leave(s.assembly, 1, depth));
    EXPECT_EQ(r.result.outcome(), Outcome::infeasible);
    EXPECT_EQ(r.result.blocked_by, std::vector<PartId>{0});
    EXPECT_EQ(r.result.message, "claimed");
    ASSERT_NE(r.certificate, nullptr);
    EXPECT_EQ(r.certificate->kind, "lock");
    EXPECT_TRUE(r.certificate->full_tolerance);
    EXPECT_EQ(r.certificate->margin, s.options.verify.max_penetration);
  }
  const Attempt path = leave(s.assembly, 0);
  const AttemptResult& proposed =
      s.oracle->propose(path, {{Pose{}}, {Pose{{0, 0, 9}, Eigen::Quaterniond::Identity()}}}, s.context);
  EXPECT_EQ(proposed.result.outcome(), Outcome::infeasible);
  EXPECT_EQ(searches, 0);
  s.ask(leave(s.assembly, 2));
  EXPECT_EQ(searches, 1) << "the third part is free";
}

TEST(ProofSchedule, LowEffortComesAfterSearchesOfSomeDepth) {
  for (const bool placed : {false, true}) {
    Asked low;
    int searches = 0;
    Rig s(row(2), with(fake::setup(touching({}, searches)), {low.prover("low", placed ? kPlaced : kLow)}));
    EXPECT_EQ(s.ask(leave(s.assembly, 0, 2)).result.outcome(), Outcome::depth_limit) << "a short search is cheaper";
    EXPECT_EQ(low.parts.size(), 0U);
    EXPECT_EQ(s.ask(leave(s.assembly, 0, 3)).result.outcome(), Outcome::infeasible);
    EXPECT_EQ(s.ask(leave(s.assembly, 0)).result.outcome(), Outcome::infeasible);
    EXPECT_EQ(searches, 2);
    EXPECT_EQ(low.parts.size(), 1U) << "an answer is remembered";
  }
}

TEST(ProofSchedule, ThePartThatASearchTouchedIsAskedWhetherItHolds) {
  Asked low;
  int searches = 0;
  Rig s(row(4), with(fake::setup(touching({2}, searches)), {low.prover("low", kLow)}));
  EXPECT_EQ(s.ask(leave(s.assembly, 0, 2)).result.outcome(), Outcome::infeasible);
  EXPECT_EQ(low.parts, (std::vector<std::vector<PartId>>{{0, 2}})) << "no other pair";
}

/// A planner that finds a path if it may spend `needed` steps; counts how often it was given less.
auto spending(std::uint64_t needed, int& cut_short) {
  return [needed, &cut_short](const PathQuery& query, RunContext& context) {
    if (query.budget.max_steps == 0 || query.budget.max_steps >= needed) return fake::push(query, context);
    ++cut_short;
    return outcome(Outcome::timeout);
  };
}

TEST(ProofSchedule, ASearchIsOverBeforeAProofThatCostsAsMuch) {
  Rng rng(27);
  for (int trial = 0; trial < 60; ++trial) {
    RunOptions options;
    options.proofs.low_effort_steps = 1 + static_cast<std::int64_t>(rng.below(1000));
    options.proofs.medium_effort_steps =
        2 * options.proofs.low_effort_steps + static_cast<std::int64_t>(rng.below(1000));
    const std::uint64_t first = static_cast<std::uint64_t>(options.proofs.low_effort_steps),
                        second = static_cast<std::uint64_t>(options.proofs.medium_effort_steps) - first;
    const std::uint64_t needed = 1 + rng.below(3 * static_cast<std::uint64_t>(options.proofs.medium_effort_steps));
    const unsigned depth = rng.below(2) == 0 ? 0 : 1 + static_cast<unsigned>(rng.below(6));
    // Of a pair, at any depth: so long a search has cost more.
    const bool asks_low = needed > first, asks_medium = asks_low && needed > second;
    for (const bool proves : {false, true}) {
      Asked low, medium;
      low.proves = false;
      medium.proves = proves;
      int cut_short = 0;
      Rig s(row(2),
            with(fake::setup(spending(needed, cut_short)), {low.prover("l", kLow), medium.prover("m", kMedium)}), 1,
            options);
      const AttemptResult& r = s.ask(leave(s.assembly, 0, depth));
      EXPECT_EQ(low.parts.size(), asks_low ? 1U : 0U) << needed;
      EXPECT_EQ(medium.parts.size(), asks_medium ? 1U : 0U) << needed;
      EXPECT_EQ(cut_short, int{asks_low} + int{asks_medium});
      EXPECT_EQ(r.result.outcome(), proves && asks_medium ? Outcome::infeasible : Outcome::solved);
      EXPECT_EQ(r.certificate != nullptr, proves && asks_medium);
    }
  }
}

/// A long search for one of a pair is asked about once, first at the reduced tolerance; only a proof for the whole
/// tolerance ends it.
TEST(ProofSchedule, ALongSearchOfAPairWaitsForTheMostExpensiveProof) {
  for (const bool is_long : {false, true})
    for (const double provable : {0.0, 0.5, 1.0}) {  // shares of the tolerance up to this
      const RunOptions options;
      const auto steps = static_cast<std::uint64_t>(options.proofs.high_effort_steps);
      std::vector<double> shares;
      const NamedProver high = fake::prover("high", kHigh, [&](const SeparationQuery& q, const RunContext&) {
        shares.push_back(q.share);
        return q.share <= provable ? std::optional(fake::claim(q)) : std::nullopt;
      });
      int cut_short = 0;
      Rig s(row(2), with(fake::setup(spending(is_long ? 2 * steps : 100, cut_short)), {high}), 1, options);
      const AttemptResult& r = s.ask(leave(s.assembly, 0, 0));
      const std::vector<double> asked = !is_long       ? std::vector<double>{}
                                        : provable > 0 ? std::vector<double>{options.proofs.reduced_tolerance, 1}
                                                       : std::vector<double>{options.proofs.reduced_tolerance};
      EXPECT_EQ(shares, asked);
      EXPECT_EQ(r.result.outcome(), is_long && provable == 1 ? Outcome::infeasible : Outcome::solved);
    }
}

TEST(ProofSchedule, MediumEffortComesAfterDeepSearchesThatFoundNothing) {
  Asked medium;
  int searches = 0;
  Rig s(row(2), with(fake::setup(touching({1}, searches)), {medium.prover("medium", kMedium)}));
  EXPECT_EQ(s.ask(leave(s.assembly, 0, 3)).result.outcome(), Outcome::depth_limit);
  EXPECT_EQ(medium.parts.size(), 0U);
  const AttemptResult& r = s.ask(leave(s.assembly, 0, 4));
  EXPECT_EQ(r.result.outcome(), Outcome::infeasible);
  EXPECT_EQ(r.result.blocked_by, std::vector<PartId>{1});
  EXPECT_EQ(searches, 2);
  EXPECT_EQ(medium.parts, (std::vector<std::vector<PartId>>{{0, 1}}));
  EXPECT_EQ(medium.shares, std::vector<double>{1});
}

TEST(ProofSchedule, HighEffortWaitsUntilNoDeeperSearchCanFollow) {
  for (const Outcome end : {Outcome::depth_limit, Outcome::exhausted}) {
    Asked high;
    int searches = 0;
    Rig s(row(2), with(fake::setup(touching({1}, searches, end)), {high.prover("high", kHigh)}));
    EXPECT_EQ(s.ask(leave(s.assembly, 0, 9)).certificate == nullptr, end == Outcome::depth_limit);
    EXPECT_EQ(high.parts.size(), end == Outcome::depth_limit ? 0U : 1U);
    EXPECT_NE(s.ask(leave(s.assembly, 0)).certificate, nullptr) << "a search without a limit is the last one";
    EXPECT_EQ(high.shares, std::vector<double>{0.5});
  }
}

TEST(ProofSchedule, HalfOfTheToleranceProvesNothingOfPathsButSaysWhy) {
  Asked costly;
  int searches = 0;
  const NamedProver half = fake::prover("half", kHigh, [&](const SeparationQuery& q, const RunContext&) {
    costly.shares.push_back(q.share);
    return q.share < 1 ? std::optional(claim(q)) : std::nullopt;
  });
  Rig s(row(2), with(fake::setup(touching({1}, searches, Outcome::exhausted)), {half}));
  const AttemptResult& r = s.ask(leave(s.assembly, 0, 5));
  EXPECT_EQ(r.result.outcome(), Outcome::exhausted);
  EXPECT_EQ(costly.shares, (std::vector<double>{0.5}));
  ASSERT_NE(r.certificate, nullptr);
  EXPECT_FALSE(r.certificate->full_tolerance);
  EXPECT_LT(r.certificate->margin, s.options.verify.max_penetration);
}

TEST(ProofSchedule, HowOneOfManyIsHeldIsNotAskedAfterEachSearch) {
  Asked pairs, groups;
  int searches = 0;
  Rig s(row(3), with(fake::setup(touching({2}, searches, Outcome::exhausted)),
                     {pairs.prover("p", kHigh), groups.prover("g", kGroups)}));
  s.ask(leave(s.assembly, 0, 4));
  s.ask(leave(s.assembly, 1));
  EXPECT_TRUE(pairs.parts.empty());
  EXPECT_TRUE(groups.parts.empty());
}

/// A whole run, with a sequence planner that tries every part once and removes none.
RunResult end_of_run(const std::vector<PartId>& blocked_by, std::vector<NamedProver> provers) {
  int searches = 0;
  RunContext context;
  return run(row(3),
             with(fake::setup(touching(blocked_by, searches), std::make_shared<fake::InTurn>()), std::move(provers)),
             RunOptions{}, context);
}

TEST(ProofSchedule, PartsThatAreLeftAreProvedToBeHeldAtTheEnd) {
  Asked pairs;
  const RunResult r = end_of_run({2}, {pairs.prover("p", kHigh)});
  EXPECT_EQ(pairs.parts, (std::vector<std::vector<PartId>>{{0, 2}, {0, 2}, {1, 2}, {1, 2}}))
      << "each and the only one that it touched, with the reduced tolerance first";
  ASSERT_EQ(r.plan.unsolved.size(), 3U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(r.plan.unsolved[i].outcome, Outcome::infeasible);
    ASSERT_TRUE(r.plan.unsolved[i].certificate);
    EXPECT_EQ(r.plan.certificates.at(*r.plan.unsolved[i].certificate).kind, "p");
  }
  EXPECT_EQ(r.plan.unsolved[2].outcome, Outcome::depth_limit) << "it touched nothing";
  EXPECT_FALSE(r.plan.unsolved[2].certificate);
}

TEST(ProofSchedule, SeveralPartsThatAreLeftAreAskedAboutTogether) {
  Asked groups;
  const RunResult r = end_of_run({}, {groups.prover("g", kGroups)});
  EXPECT_EQ(groups.parts, (std::vector<std::vector<PartId>>{{0, 1, 2}})) << "once";
  EXPECT_EQ(r.plan.certificates.size(), 1U);
  for (const auto& u : r.plan.unsolved) {
    EXPECT_EQ(u.outcome, Outcome::depth_limit) << "half of the tolerance proves nothing of paths";
    EXPECT_EQ(u.certificate, std::optional<std::size_t>(0));
  }
}

/// With a deadline, no proof of high effort may use up the time of all others.
TEST(ProofSchedule, ADeadlineIsSharedAndProofsOfHighEffortGetTheirShare) {
  for (const double share : {0.1, 0.5}) {
    double high_left = 0, low_left = 0;
    const auto notes = [](double& left) {
      return [&left](const SeparationQuery&, const RunContext& context) {
        left = context.deadline.seconds_left();
        return std::optional<Certificate>();
      };
    };
    int searches = 0;
    RunOptions options;
    options.proofs.deadline_share = share;
    RunContext context;
    context.deadline = Deadline::after_seconds(1000);
    Rig s(row(2),
          with(fake::setup(touching({}, searches)),
               {fake::prover("high", kHigh, notes(high_left)), fake::prover("low", kLow, notes(low_left))}),
          1, options);
    EXPECT_EQ(s.oracle->prove({{0, 1}, ProofEffort::high, 1}, context), nullptr);
    EXPECT_EQ(s.oracle->prove({{0, 1}, ProofEffort::low, 1}, context), nullptr);
    EXPECT_GT(high_left, 900 * share);
    EXPECT_LE(high_left, 1000 * share);
    EXPECT_GT(low_left, 900);
  }
}

TEST(ProofSchedule, WhatIsFoundIsNotProvedAway) {
  Asked costly;
  Rig s(row(2), with(fake::setup(fake::push), {costly.prover("m", kMedium), costly.prover("h", kHigh)}));
  EXPECT_EQ(s.ask(leave(s.assembly, 0)).result.outcome(), Outcome::solved);
  EXPECT_EQ(costly.parts.size(), 0U);
}

TEST(ProofSchedule, WithoutProversNothingIsProved) {
  int searches = 0;
  Assembly assembly = row(3);
  assembly.overlaps = {{0, 1, 0.1}};
  Rig s(assembly, fake::setup(touching({1}, searches)));
  const AttemptResult& r = s.ask(leave(s.assembly, 0));
  EXPECT_EQ(r.result.outcome(), Outcome::depth_limit);
  EXPECT_EQ(r.certificate, nullptr);
  for (const ProofEffort e : {ProofEffort::trivial, ProofEffort::low, ProofEffort::medium, ProofEffort::high})
    EXPECT_EQ(s.oracle->prove({{0, 1}, e, 1}, s.context), nullptr);
}

TEST(ProofSchedule, OneProofForAllThreadsThatAsk) {
  std::atomic<int> asked{0};
  int searches = 0;
  const NamedProver counted = fake::prover("counted", kLow, [&](const SeparationQuery& q, const RunContext&) {
    ++asked;
    std::this_thread::yield();
    return std::optional(claim(q));
  });
  for (int trial = 0; trial < 20; ++trial) {
    asked = 0;
    Rig s(row(2), with(fake::setup(touching({}, searches)), {counted}));
    std::vector<const Certificate*> seen(4);
    {
      std::vector<std::jthread> threads;
      for (std::size_t k = 0; k < seen.size(); ++k)
        threads.emplace_back([&s, &seen, k] {
          seen[k] = s.oracle->prove(
              {k % 2 == 0 ? std::vector<PartId>{0, 1} : std::vector<PartId>{1, 0}, ProofEffort::low, 1}, {});
        });
    }
    EXPECT_EQ(asked, 1);
    for (const Certificate* c : seen) EXPECT_EQ(c, seen[0]);
    ASSERT_NE(seen[0], nullptr);
  }
}

TEST(ProofSchedule, AStoppedProofSaysNothing) {
  int searches = 0;
  const NamedProver patient = fake::prover("patient", kLow, [](const SeparationQuery& q, const RunContext& c) {
    return c.should_stop() ? std::nullopt : std::optional(claim(q));
  });
  Rig s(row(2), with(fake::setup(touching({}, searches)), {patient}));
  RunContext stopped;
  stopped.cancel.cancel();
  EXPECT_EQ(s.oracle->prove({{0, 1}, ProofEffort::low, 1}, stopped), nullptr);
  EXPECT_NE(s.oracle->prove({{0, 1}, ProofEffort::low, 1}, {}), nullptr);
}

TEST(ProofSchedule, AProverThatThrowsProvesNothingAndIsReported) {
  int searches = 0;
  const NamedProver broken =
      fake::prover("broken", kLow, [](const SeparationQuery&, const RunContext&) -> std::optional<Certificate> {
        throw std::runtime_error("no idea");
      });
  Asked next;
  next.proves = false;
  Rig s(row(2), with(fake::setup(touching({}, searches)), {broken, next.prover("next", kLow)}));
  EXPECT_EQ(s.ask(leave(s.assembly, 0, 3)).result.outcome(), Outcome::depth_limit);
  ASSERT_EQ(s.errors.size(), 1U);
  EXPECT_NE(s.errors[0].find("no idea"), std::string::npos);
  EXPECT_EQ(next.parts.size(), 1U) << "the others are still asked";
}

TEST(ProofSchedule, QuestionsThatMakeNoSense) {
  Rig s(row(2), fake::setup(fake::push));
  for (const std::vector<PartId>& parts : {std::vector<PartId>{}, {0}, {0, 0}, {0, 7}})
    EXPECT_THROW(s.oracle->prove({parts, ProofEffort::low, 1}, {}), std::invalid_argument);
  for (const double share : {0.0, -1.0, 1.5})
    EXPECT_THROW(s.oracle->prove({{0, 1}, ProofEffort::low, share}, {}), std::invalid_argument);
}

/// Two parts leave the other two together; then nothing is searched for. The proof is about the group of a part, and
/// the report has it, whether it covers the full tolerance or not.
TEST(ProofSchedule, RemainingPartsAreReportedWithTheProofOfTheirGroup) {
  const auto separates_pairs = std::make_shared<fake::Custom>(
      [](const Assembly&, PathOracle& oracle, SequenceObserver& observer, RunContext& context) {
        Attempt attempt;
        attempt.moving = {{0, Pose{}}, {1, Pose{}}};
        attempt.fixed = {{2, Pose{}}, {3, Pose{}}};
        SequenceResult result;
        result.outcome = Outcome::exhausted;
        result.removals.push_back({{0, 1}, &oracle.attempt(attempt, context)});
        observer.removed(result.removals.back(), 2);
        for (const PartId id : {0U, 1U, 2U, 3U}) {
          result.remaining.push_back(id);
          result.unsolved.push_back({id, Outcome::exhausted, {}, {}, "searched", nullptr});
        }
        return result;
      });
  for (const double largest_share : {1.0, 0.5}) {
    const NamedProver prover =
        fake::prover("p", kHigh, [&](const SeparationQuery& q, const RunContext&) -> std::optional<Certificate> {
          return q.share <= largest_share ? std::optional(claim(q)) : std::nullopt;
        });
    RunContext context;
    const RunResult r = run(row(4), with(fake::setup(fake::push, separates_pairs), {prover}), {}, context);
    ASSERT_TRUE(r.plan.disassembly.size() == 1 && r.plan.unsolved.size() == 4);
    for (const PlanUnsolved& u : r.plan.unsolved) {
      const auto id = static_cast<unsigned>(u.part.back() - '0');
      EXPECT_EQ(u.outcome, largest_share < 1 ? Outcome::exhausted : Outcome::infeasible);
      EXPECT_EQ(u.message, "claimed");
      EXPECT_EQ(u.blocked_by, std::vector<std::string>{"block" + std::to_string(id ^ 1U)});
      EXPECT_TRUE(u.certificate.has_value());
    }
  }
}

}  // namespace
}  // namespace dismantle
