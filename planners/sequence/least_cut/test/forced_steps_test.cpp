// Forced steps as a last resort: when they are made, how deep they cut in, and how the plan states them.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "dismantle/testing/fake_prover.h"
#include "dismantle/verification/check_plan.h"
#include "last_resort.h"

namespace dismantle {
namespace {

using fake::InTurn;

RunResult last_resort_in_turn(const Assembly& assembly, const RunContext& context = {}) {
  return fake::forced_run(assembly, std::make_shared<InTurn>(), context);
}

/// A plate in a closed box, forced out of it. Made once: several tests look at the same plan.
const RunResult& forced_closed_box() {
  static const RunResult result = last_resort_in_turn(fake::closed_box());
  return result;
}

PlanCheck check(const Plan& plan, const Assembly& assembly) {
  RunContext context;
  return check_plan(plan, assembly, VerifyOptions{}, context);
}

TEST(ForcedSteps, OffLeavesWhatIsStuck) {
  const RunResult r = fake::run_in_turn(fake::closed_box());
  EXPECT_EQ(r.plan.status, PlanStatus::partial);
  EXPECT_EQ(r.plan.forced_steps(), 0u);
}

TEST(ForcedSteps, WhatIsStuckIsTakenOutWhereItCutsInLeast) {
  const Assembly assembly = fake::closed_box();
  const RunResult& r = forced_closed_box();
  EXPECT_EQ(r.plan.status, PlanStatus::forced);
  EXPECT_NE(r.outcome, Outcome::solved);
  ASSERT_EQ(r.plan.disassembly.size(), 1u);
  EXPECT_TRUE(r.plan.unsolved.empty());
  const auto& forced = r.plan.disassembly.front().forced;
  ASSERT_TRUE(forced);
  // A plate 0.2 thick through walls 0.1 thick: broadside or edgewise, each way out cuts in by at least half of the
  // plate.
  EXPECT_NEAR(forced->depth, 0.1, 0.1 * 0.1 + 0.01);
  EXPECT_EQ(forced->assembled, 0);
  EXPECT_FALSE(forced->reason.empty());
  const PlanCheck c = check(r.plan, assembly);
  EXPECT_TRUE(c.valid) << (c.problems.empty() ? "" : c.problems.front().message);
  EXPECT_FALSE(c.complete);
  EXPECT_EQ(c.forced, 1u);
}

/// The planner had no time for proofs; provers are still asked about the pair that is cut.
TEST(ForcedSteps, ThePairThatIsCutIsAskedAboutAndItsProofIsCited) {
  for (const bool proves : {true, false}) {
    int asked = 0;
    PlanningSetup setup = fake::setup(fake::push, fake::last_resort_after(std::make_shared<fake::Custom>(
                                                      [](const Assembly&, PathOracle&, SequenceObserver&, RunContext&) {
                                                        SequenceResult result;
                                                        result.outcome = Outcome::cancelled;
                                                        return result;
                                                      })));
    RunOptions options;
    options.force = ForceWhen::last_resort;
    setup.provers = {
        fake::prover("medium", {ProofEffort::medium, 2, 2, false}, [&](const SeparationQuery& q, const RunContext&) {
          ++asked;
          return proves ? std::optional(fake::claim(q, "held")) : std::nullopt;
        })};
    RunContext context;
    const RunResult r = run(fake::closed_box(), setup, options, context);
    ASSERT_EQ(r.plan.disassembly.size(), 1u);
    const auto& forced = r.plan.disassembly.front().forced;
    ASSERT_TRUE(forced);
    EXPECT_EQ(asked, 1);
    ASSERT_EQ(forced->certificate.has_value(), proves);
    if (!proves) continue;
    const PlanCertificate& proof = r.plan.certificates.at(*forced->certificate);
    EXPECT_EQ(proof.kind, "medium");
    EXPECT_EQ(std::set<std::string>(proof.parts.begin(), proof.parts.end()),
              (std::set<std::string>{forced->part, forced->other}));
    EXPECT_EQ(forced->reason, "held");
  }
}

/// The time went into a search for the box; the plate had not had its turn. The reason names the search.
TEST(ForcedSteps, ASearchForThePartnerOfAPairIsTheReasonAndNotThatThePartWasNotTried) {
  const auto box_only = [](const Assembly&, PathOracle& oracle, SequenceObserver&, RunContext& context) {
    Attempt attempt;
    attempt.moving = {{0, Pose{}}};
    attempt.fixed = {{1, Pose{}}};
    EXPECT_FALSE(is_success(oracle.attempt(attempt, context).result.outcome()));
    SequenceResult result;
    result.outcome = Outcome::cancelled;
    for (const PartId id : {0U, 1U})
      result.unsolved.push_back({id, Outcome::cancelled, {}, {}, "not tried: stopped before its turn"});
    return result;
  };
  const RunResult r = fake::forced_run(fake::closed_box(), std::make_shared<fake::Custom>(box_only));
  ASSERT_EQ(r.plan.forced_steps(), 1U);
  const std::string& reason = r.plan.disassembly.front().forced->reason;
  EXPECT_EQ(reason.find("not tried"), std::string::npos) << reason;
  EXPECT_NE(reason.find("1 search of"), std::string::npos) << reason;
}

/// The line that the reason of a forced step suggests turns the step into an accepted one.
TEST(ForcedSteps, WhatTheReasonSuggestsIsAccepted) {
  const std::string reason = forced_closed_box().plan.disassembly.front().forced->reason;
  ASSERT_NE(reason.find("as: snap, depth: "), std::string::npos) << reason;
  RunOptions options;
  options.constraints.accept = {{1, 0, "snap", std::stod(reason.substr(reason.find("depth: ") + 7))}};
  const RunResult r = fake::forced_run(fake::closed_box(), std::make_shared<InTurn>(), {}, options);
  EXPECT_EQ(r.plan.status, PlanStatus::complete);
}

/// A closed box of thin walls around two cubes.
Assembly box_with_two_cubes() {
  return fake::assembly_of({{"box",
                             {{{-2, -1, -1}, {2, 1, -0.9}},
                              {{-2, -1, 0.9}, {2, 1, 1}},
                              {{-2, -1, -0.9}, {-1.9, 1, 0.9}},
                              {{1.9, -1, -0.9}, {2, 1, 0.9}},
                              {{-1.9, -1, -0.9}, {1.9, -0.9, 0.9}},
                              {{-1.9, 0.9, -0.9}, {1.9, 1, 0.9}}}},
                            {"left", {{{-1.5, -0.5, -0.5}, {-0.5, 0.5, 0.5}}}},
                            {"right", {{{0.5, -0.5, -0.5}, {1.5, 0.5, 0.5}}}}});
}

/// A proof says that its first part cannot leave the others while these keep their places. It says nothing about a step
/// that parts these others from each other.
TEST(ForcedSteps, AProofIsCitedOnlyWhereItsFirstPartLeavesAllItsOthers) {
  const Assembly assembly = box_with_two_cubes();
  unsigned cited = 0;
  for (PartId first = 0; first < 3; ++first) {
    PlanningSetup setup = fake::setup(fake::push, fake::last_resort_after(std::make_shared<InTurn>()));
    RunOptions options;
    options.force = ForceWhen::last_resort;
    setup.provers = {
        fake::prover("group", {ProofEffort::high, 3, 4, false}, [&](const SeparationQuery& q, const RunContext&) {
          Certificate c = fake::claim(q, "held");
          std::iter_swap(c.parts.begin(), std::find(c.parts.begin(), c.parts.end(), first));
          return std::optional(c);
        })};
    RunContext context;
    const Plan plan = run(assembly, setup, options, context).plan;
    ASSERT_EQ(plan.forced_steps(), 1U);  // the box leaves both cubes: one step where two would be as deep each
    ASSERT_FALSE(plan.certificates.empty());
    std::set<std::string> group{"box", "left", "right"};
    for (const PlanStep& step : plan.disassembly) {
      std::set<std::string> moving;
      for (const PlanMove& move : step.moves) moving.insert(move.part);
      if (step.forced && step.forced->certificate) {
        const std::vector<std::string>& parts = plan.certificates.at(*step.forced->certificate).parts;
        for (std::size_t k = 1; k < parts.size(); ++k) {
          EXPECT_TRUE(group.contains(parts[k]));
          EXPECT_NE(moving.contains(parts[0]), moving.contains(parts[k]))
              << parts[0] << ", step of " << *moving.begin();
        }
        ++cited;
      } else {
        EXPECT_NE(step.forced->reason, "held");
      }
      for (const std::string& part : moving) group.erase(part);
    }
  }
  EXPECT_GT(cited, 0U);
}

TEST(ForcedSteps, AFalseDepthIsRefused) {
  const Assembly assembly = fake::closed_box();
  const Plan& plan = forced_closed_box().plan;
  for (const double factor : {0.0, 0.5, 1.5, 3.0}) {
    Plan edited = plan;
    edited.disassembly.front().forced->depth *= factor;
    EXPECT_FALSE(check(edited, assembly).valid) << factor;
  }
  Plan unmarked = plan;
  unmarked.disassembly.front().forced.reset();
  EXPECT_FALSE(check(unmarked, assembly).valid);
  Plan called_complete = plan;
  called_complete.status = PlanStatus::complete;
  EXPECT_FALSE(check(called_complete, assembly).valid);
}

TEST(ForcedSteps, NoneWhereVerifiedOnesDo) {
  for (const unsigned n : {1u, 3u, 5u}) {
    const Assembly assembly = fake::tube_with_blocks(n);
    const RunResult off = fake::run_in_turn(assembly), on = last_resort_in_turn(assembly);
    EXPECT_EQ(on.plan.status, PlanStatus::complete);
    EXPECT_EQ(fake::text_without_times(off.plan), fake::text_without_times(on.plan));
  }
}

/// A closed box of wall `wall` around a plate, `n` blocks in a row beside it, and one more inside a tube.
Assembly box_and_row(unsigned n) {
  std::vector<std::pair<std::string, std::vector<fake::Box>>> parts{{"box",
                                                                     {{{-2, -2, -2}, {2, 2, -1.9}},
                                                                      {{-2, -2, 1.9}, {2, 2, 2}},
                                                                      {{-2, -2, -1.9}, {-1.9, 2, 1.9}},
                                                                      {{1.9, -2, -1.9}, {2, 2, 1.9}},
                                                                      {{-1.9, -2, -1.9}, {1.9, -1.9, 1.9}},
                                                                      {{-1.9, 1.9, -1.9}, {1.9, 2, 1.9}}}},
                                                                    {"plate", {{{-1, -1, -0.1}, {1, 1, 0.1}}}}};
  for (unsigned k = 0; k < n; ++k)
    parts.push_back({"block" + std::to_string(k), {{{3.0 + 2.0 * k, 0, 0}, {4.0 + 2.0 * k, 1, 1}}}});
  return fake::assembly_of(parts);
}

TEST(ForcedSteps, VerifiedOnesComeFirstAndGoOnAfterwards) {
  for (const unsigned n : {1u, 4u}) {
    const Assembly assembly = box_and_row(n);
    const RunResult r = last_resort_in_turn(assembly);
    EXPECT_EQ(r.plan.status, PlanStatus::forced);
    EXPECT_EQ(r.plan.forced_steps(), 1u);
    EXPECT_EQ(r.plan.disassembly.size(), n + 1);
    EXPECT_TRUE(check(r.plan, assembly).valid);
  }
}

TEST(ForcedSteps, ThePlanDoesNotDependOnThreads) {
  const Assembly assembly = box_and_row(3);
  RunContext two;
  two.threads = 2;
  EXPECT_EQ(fake::text_without_times(last_resort_in_turn(assembly).plan),
            fake::text_without_times(last_resort_in_turn(assembly, two).plan));
}

TEST(ForcedSteps, WhatLeftAsAGroupIsTakenApartWhereItStands) {
  // The group of box and plate leaves first, whole; then the plate is forced out of it, far from where it was.
  const Assembly assembly = box_and_row(1);
  const auto steps = [](const Assembly&, PathOracle& oracle, SequenceObserver& observer, RunContext& context) {
    Attempt attempt;
    attempt.moving = {{0, Pose{}}, {1, Pose{}}};
    attempt.fixed = {{2, Pose{}}};
    const AttemptResult& answer = oracle.attempt(attempt, context);
    SequenceResult result;
    result.outcome = Outcome::exhausted;
    EXPECT_TRUE(is_success(answer.result.outcome()));
    result.removals.push_back({{0, 1}, &answer});
    observer.removed(result.removals.back(), 2);
    return result;
  };
  const RunResult r = fake::forced_run(assembly, std::make_shared<fake::Custom>(steps));
  EXPECT_EQ(r.plan.status, PlanStatus::forced);
  EXPECT_EQ(r.plan.disassembly.size(), 2u);
  EXPECT_TRUE(check(r.plan, assembly).valid);
}

TEST(ForcedSteps, ConstraintsHold) {
  RunOptions options;
  options.constraints.base = {1};
  options.constraints.together = {{0, 1}};
  class Keeps final : public InTurn {
   public:
    SequencePlannerTraits traits() const noexcept override { return {.keeps_constraints = true, .any_start = true}; }
  };
  const RunResult r = fake::forced_run(fake::closed_box(), std::make_shared<Keeps>(), {}, options);
  EXPECT_EQ(r.plan.forced_steps(), 0u);
}

TEST(ForcedSteps, AfterAForcedStepADisplacedGroupIsPlannedAsAnyOther) {
  const Assembly assembly = box_and_row(2);
  class GroupFirst final : public InTurn {
   public:
    SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                        RunContext& context) override {
      if (query.start.front().size() < 4) return InTurn::plan(query, oracle, observer, context);
      Attempt attempt;  // box, plate and the first block leave the second one
      attempt.moving = {{0, Pose{}}, {1, Pose{}}, {2, Pose{}}};
      attempt.fixed = {{3, Pose{}}};
      const AttemptResult& answer = oracle.attempt(attempt, context);
      SequenceResult result;
      result.outcome = Outcome::timeout;
      result.removals.push_back({{0, 1, 2}, &answer});
      observer.removed(result.removals.back(), 3);
      return result;
    }
  };
  const RunResult r = fake::forced_run(assembly, std::make_shared<GroupFirst>());
  EXPECT_EQ(r.plan.status, PlanStatus::forced);
  ASSERT_EQ(r.plan.disassembly.size(), 3u);
  EXPECT_EQ(r.plan.forced_steps(), 1u);
  const PlanCheck c = check(r.plan, assembly);
  EXPECT_TRUE(c.valid) << (c.problems.empty() ? "" : c.problems.front().message);
}

}  // namespace
}  // namespace dismantle
