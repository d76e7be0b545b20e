// What the planner does with proofs that parts cannot be separated. The provers here follow a script.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "dismantle/plan_io/plan_file.h"
#include "dismantle/testing/held_shapes.h"
#include "run_blocking.h"

namespace dismantle {
namespace {

using fake::shallow;
using fake::take_apart;

/// Proves the sets on its list inseparable, at one effort.
class ListedProver final : public ImmobilityProver {
 public:
  ListedProver(ProofEffort effort, std::set<std::vector<PartId>> inseparable, std::size_t parts = 2)
      : effort_(effort), inseparable_(std::move(inseparable)), parts_(parts) {}
  ProverTraits traits() const noexcept override {
    return {.effort = effort_, .min_parts = parts_, .max_parts = parts_};
  }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext&) const override {
    Certificate certificate;
    for (const auto* list : {&query.moving, &query.fixed})
      for (const PlacedPart& p : *list) certificate.parts.push_back(p.part);
    std::sort(certificate.parts.begin(), certificate.parts.end());
    if (!inseparable_.contains(certificate.parts)) return std::nullopt;
    certificate.text = "listed";
    return certificate;
  }

 private:
  ProofEffort effort_;
  std::set<std::vector<PartId>> inseparable_;
  std::size_t parts_;
};

/// `count` pairs of a block and a casing that it cannot leave along any direction: parts 2 k and 2 k + 1.
Assembly cased_pairs(PartId count) {
  const shapes::Cased held{{0.5, 0.4, 0.3}, 0.02, 0.1, 0.15};
  std::vector<Mesh> parts;
  for (PartId k = 0; k < count; ++k) {
    const Pose there = shapes::shift({3.0 * static_cast<double>(k), 0, 0});
    parts.push_back(shapes::moved(held.around(), there));
    parts.push_back(shapes::moved(held.block(), there));
  }
  return shapes::assembly_of(parts);
}

TEST(BlockingProofs, ProvedPairsAreReportedWithTheProof) {
  Rng rng(7);
  for (const ProofEffort effort : {ProofEffort::low, ProofEffort::medium, ProofEffort::high})
    for (int trial = 0; trial < 3; ++trial) {
      std::set<std::vector<PartId>> listed;
      std::set<std::string> expected;
      for (PartId k = 0; k < 3; ++k)
        if (rng.uniform() < 0.6) {
          listed.insert({2 * k, 2 * k + 1});
          expected.insert("part" + std::to_string(2 * k));
          expected.insert("part" + std::to_string(2 * k + 1));
        }
      RunResult r =
          take_apart(cased_pairs(3), 1, {}, &shallow, {{"listed", std::make_shared<ListedProver>(effort, listed)}});
      EXPECT_NE(r.outcome, Outcome::solved);
      EXPECT_EQ(r.plan.disassembly.size(), 2u) << "the pairs themselves are apart";
      std::set<std::string> reported;
      for (const auto& u : r.plan.unsolved)
        if (u.message == "listed") {
          reported.insert(u.part);
          EXPECT_TRUE(u.certificate.has_value());
          EXPECT_EQ(u.blocked_by.size(), 1u);
        }
      EXPECT_EQ(reported, expected);
      EXPECT_EQ(r.plan.unsolved.size(), 6u);
    }
}

TEST(BlockingProofs, ThreeOfWhichNoTwoAreProvedInseparableAreReportedTogether) {
  const shapes::Keyed keyed{.play = 0.003};
  const Assembly assembly = shapes::assembly_of({keyed.slab(), keyed.tray(), keyed.block()});
  RunResult r = take_apart(
      assembly, 1, {}, &fake::helpless,
      {{"listed", std::make_shared<ListedProver>(ProofEffort::high, std::set<std::vector<PartId>>{{0, 1, 2}}, 3)}});
  EXPECT_TRUE(r.plan.disassembly.empty());
  EXPECT_GT(r.counts.attempts, 0) << "the proof comes after the searches";
  ASSERT_EQ(r.plan.unsolved.size(), 3u);
  for (const auto& u : r.plan.unsolved) {
    EXPECT_EQ(u.message, "listed");
    EXPECT_EQ(u.blocked_by.size(), 2u);
    EXPECT_EQ(std::count(u.blocked_by.begin(), u.blocked_by.end(), u.part), 0);
  }
}

/// Proofs about pairs that connect all parts: whatever moves, nothing leaves. The third part is not searched for any
/// more, and no arrangements.
TEST(BlockingProofs, AGroupThatPairsHoldTogetherIsGivenUp) {
  const shapes::Keyed keyed{.play = 0.003};
  const Assembly assembly = shapes::assembly_of({keyed.slab(), keyed.tray(), keyed.block()});
  const auto searches = [&](std::set<std::vector<PartId>> listed) {
    RunResult r = take_apart(assembly, 1, {}, &shallow,
                             {{"listed", std::make_shared<ListedProver>(ProofEffort::low, std::move(listed))}});
    EXPECT_TRUE(r.plan.disassembly.empty());
    EXPECT_EQ(r.plan.unsolved.size(), 3u);
    return std::pair(r.counts.attempts, std::count_if(r.plan.unsolved.begin(), r.plan.unsolved.end(),
                                                      [](const auto& u) { return u.message == "listed"; }));
  };
  const auto [attempts, proved] = searches({{0, 1}, {1, 2}});
  const auto [attempts_of_one, proved_of_one] = searches({{0, 1}});
  EXPECT_EQ(proved, 3) << "each by a proof that names it";
  EXPECT_EQ(proved_of_one, 2);
  EXPECT_EQ(attempts, 6) << "seven, if the part that both others hold is searched for to depth 2, too";
  EXPECT_GT(attempts_of_one, attempts);
}

TEST(BlockingProofs, PartsLockedByTheirOverlapAreOneFromTheBeginning) {
  Rng rng(3);
  for (int round = 0; round < 6; ++round) {
    std::vector<std::pair<std::string, std::vector<fake::Box>>> parts;
    std::set<std::string> locked;
    std::set<std::vector<PartId>> listed;
    for (unsigned k = 0; k < 5; ++k) {
      const fake::Box box{{3.0 * k, 0, 0}, {3.0 * k + 1, 1, 1}};
      const std::string name = "block" + std::to_string(k);
      parts.push_back({name, {box}});
      if (rng.uniform() < 0.5) continue;
      const Eigen::Vector3d by(rng.uniform(0.05, 0.2), rng.uniform(0.05, 0.2), rng.uniform(0.05, 0.2));
      listed.insert({static_cast<PartId>(parts.size() - 1), static_cast<PartId>(parts.size())});
      parts.push_back({name + "_twin", {{box.lo + by, box.hi + by}}});
      locked.insert(name);
      locked.insert(name + "_twin");
    }
    Assembly assembly = fake::assembly_of(parts);
    for (const auto& pair : listed)
      assembly.overlaps.push_back(
          {pair[0], pair[1],
           penetration_depth(*assembly.parts[pair[0]].mesh, Pose{}, *assembly.parts[pair[1]].mesh, Pose{}, 1e-4)});
    const RunResult r = take_apart(assembly, 1, {}, &fake::helpless,
                                   {{"listed", std::make_shared<ListedProver>(ProofEffort::trivial, listed)}});
    EXPECT_EQ(r.outcome, locked.empty() ? Outcome::solved : Outcome::infeasible);
    std::set<std::string> reported;
    for (const auto& u : r.plan.unsolved) {
      reported.insert(u.part);
      ASSERT_EQ(u.blocked_by.size(), 1u);
      EXPECT_EQ(u.message, "listed");
      EXPECT_EQ(u.part.substr(0, 6), u.blocked_by[0].substr(0, 6)) << "each by its twin";
    }
    EXPECT_EQ(reported, locked);
    EXPECT_EQ(r.plan.disassembly.size(), 4u) << "all that is not locked comes apart";
  }
}

TEST(BlockingProofs, SamePlanOnAnyNumberOfThreads) {
  std::set<std::string> plans;
  for (const unsigned threads : {1U, 2U, 3U}) {
    RunResult r = take_apart(
        cased_pairs(2), threads, {}, &shallow,
        {{"listed", std::make_shared<ListedProver>(ProofEffort::high, std::set<std::vector<PartId>>{{0, 1}, {2, 3}})}});
    for (PlanStep& step : r.plan.disassembly) step.seconds = 0;
    for (PlanStep& step : r.plan.assembly_steps) step.seconds = 0;
    for (PlanUnsolved& u : r.plan.unsolved) u.seconds = 0;
    plans.insert(to_json(r.plan));
  }
  EXPECT_EQ(plans.size(), 1u);
}

}  // namespace
}  // namespace dismantle
