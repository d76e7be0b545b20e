// Proofs about a pair are first tried for more than the tolerance: they say more, and take less.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "dismantle/run_context.h"
#include "dismantle/testing/fake_prover.h"
#include "dismantle/testing/oracle_rig.h"
#include "dismantle/testing/run_rig.h"
#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

/// A cube in a case with thin walls, which are up to `half`, half of its edge, deep in it on any way out.
Assembly cube_in_case(double half) {
  const double in = 1.1 * half, out = 1.12 * half;
  Mesh made = shapes::box({-out, -out, -out}, {out, out, -in});
  for (const auto& [lo, hi] : {std::pair(Eigen::Vector3d(-out, -out, in), Eigen::Vector3d(out, out, out)),
                               std::pair(Eigen::Vector3d(-out, -out, -in), Eigen::Vector3d(-in, out, in)),
                               std::pair(Eigen::Vector3d(in, -out, -in), Eigen::Vector3d(out, out, in)),
                               std::pair(Eigen::Vector3d(-in, -out, -in), Eigen::Vector3d(in, -in, in)),
                               std::pair(Eigen::Vector3d(-in, in, -in), Eigen::Vector3d(in, out, in))})
    made = shapes::joined(made, shapes::box(lo, hi));
  return shapes::assembly_of({shapes::box({-half, -half, -half}, {half, half, half}), made});
}

/// Margins that a prover of high effort is asked for, in tolerances; it proves those above `least`.
std::vector<double> margins_asked(const Assembly& assembly, double least, const Certificate** found = nullptr) {
  std::vector<double> asked;
  static std::vector<std::unique_ptr<fake::Rig>> rigs;  // certificates live as long as their rig
  const double tolerance = VerifyOptions{}.max_penetration;
  const NamedProver prover =
      fake::prover("high", {ProofEffort::high, 2, 2, false},
                   [&](const SeparationQuery& q, const RunContext&) -> std::optional<Certificate> {
                     asked.push_back(q.margin() / tolerance);
                     return q.margin() > least * tolerance ? std::optional(fake::claim(q)) : std::nullopt;
                   });
  PlanningSetup setup = fake::setup([](const PathQuery&, RunContext&) {
    PathResult r = fake::outcome(Outcome::exhausted);
    r.blocked_by = {1};
    return r;
  });
  setup.provers = {prover};
  rigs.push_back(std::make_unique<fake::Rig>(assembly, setup));
  const AttemptResult& answer = rigs.back()->ask(fake::leave(rigs.back()->assembly, 0));
  if (found != nullptr) *found = answer.certificate;
  return asked;
}

TEST(CoarseProofs, AreTriedWhereWhatHoldsIsFarDeeperThanTheTolerance) {
  const double tolerance = VerifyOptions{}.max_penetration;
  // A snap is less than four of what a proof is for.
  for (const auto& [depth, first] : {std::pair(420.0, 100.0), {380.0, 10.0}, {42.0, 10.0}, {38.0, 0.5}})
    EXPECT_NEAR(margins_asked(cube_in_case(depth * tolerance), 1e9).front(), first, 1e-9) << depth;
}

TEST(CoarseProofs, AreProofsForTheWholeTolerance) {
  const double tolerance = VerifyOptions{}.max_penetration;
  const Certificate* found = nullptr;
  EXPECT_EQ(margins_asked(cube_in_case(100 * tolerance), 5, &found).size(), 1U);
  ASSERT_NE(found, nullptr);
  EXPECT_TRUE(found->full_tolerance);
  EXPECT_NEAR(found->margin, 10 * tolerance, 1e-12);
}

}  // namespace
}  // namespace dismantle
