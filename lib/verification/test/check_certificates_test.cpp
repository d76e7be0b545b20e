// Certificates of a plan: every error is found.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/testing/fake_prover.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {
namespace {

using shapes::Vec3;

/// A fake prover declares blocks 0 and 1 inseparable; block 2 leaves by a translation.
class CheckCertificates : public ::testing::Test {
 protected:
  CheckCertificates() {
    assembly_ = shapes::assembly_of({shapes::box({-5, -1, -1}, {-2, 1, 1}), shapes::box({-2, -1, -1}, {2, 1, 1}),
                                     shapes::box({2, -1, -1}, {5, 1, 1})});
    assembly_.normalization = {0.01, {100, 200, 300}};
    plan_.status = PlanStatus::partial;
    for (const auto& p : assembly_.parts) plan_.assembly.parts.push_back({p.id, p.name, p.file});
    PlanStep step;
    step.step = 1;
    step.moves.push_back({"part2", {}});
    for (int i = 0; i <= 50; ++i) step.moves[0].poses.push_back(at({0.08 * i, 0, 0}));
    step.separates = {{"part2"}};
    plan_.disassembly = {step};
    plan_.remaining = {"part0", "part1"};
    plan_.verified_max_penetration = 0.01;
    plan_.certificates = {{"decree", {"part0", "part1"}, {}, true, 0.01, {{"width", {3, 4}}}, "they hold each other"}};
    for (const char* name : {"part0", "part1"}) {
      PlanUnsolved u;
      u.part = name;
      u.outcome = Outcome::infeasible;
      u.certificate = 0;
      plan_.unsolved.push_back(u);
    }
  }

  Pose at(const Vec3& t) const { return assembly_.normalization.pose_to_input({t, Eigen::Quaterniond::Identity()}); }

  /// Proves blocks 0 and 1 immobile, as far as 0.01 goes.
  std::shared_ptr<const ImmobilityProver> decree(bool depends_on_poses) const {
    return std::make_shared<fake::ScriptedProver>(
        ProverTraits{ProofEffort::low, 2, 2, depends_on_poses},
        [depends_on_poses](const SeparationQuery& q, const RunContext&) -> std::optional<Certificate> {
          Certificate c = fake::claim(q);
          c.numbers = {{"width", {3, 4}}};
          std::vector<PartId> parts = c.parts;
          std::sort(parts.begin(), parts.end());
          if (parts != std::vector<PartId>{0, depends_on_poses ? 2U : 1U} || q.margin() > 0.01 + 1e-12)
            return std::nullopt;
          return c;
        });
  }

  PlanCheck check() const {
    RunContext context;
    return check_plan(plan_, assembly_, VerifyOptions{}, context, [this](const std::string& kind) {
      return kind == "decree" ? decree(false) : kind == "placed" ? decree(true) : nullptr;
    });
  }
  void expect_problem(const std::string& text) const {
    const PlanCheck c = check();
    std::string all;
    for (const auto& p : c.problems) all += p.message + "\n";
    EXPECT_FALSE(c.valid);
    EXPECT_EQ(c.certificates, 0U);
    EXPECT_NE(all.find(text), std::string::npos) << "expected: " << text << "\nfound: " << all;
  }

  Assembly assembly_;
  Plan plan_;
};

TEST_F(CheckCertificates, AnHonestOneHolds) {
  const PlanCheck c = check();
  EXPECT_TRUE(c.valid) << (c.problems.empty() ? "" : c.problems[0].message);
  EXPECT_FALSE(c.complete);
  EXPECT_EQ(c.certificates, 1U);
}

TEST_F(CheckCertificates, ForgedOnesDoNot) {
  const Plan honest = plan_;
  const std::vector<std::pair<std::string, std::function<void(PlanCertificate&)>>> forgeries = {
      {"cannot be proved again",
       [](PlanCertificate& c) {
         c.parts = {"part0", "part2"};
       }},
      {"is not in the assembly",
       [](PlanCertificate& c) {
         c.parts = {"part0", "part7"};
       }},
      {"is listed twice",
       [](PlanCertificate& c) {
         c.parts = {"part0", "part0"};
       }},
      {"it needs two parts", [](PlanCertificate& c) { c.parts = {"part0"}; }},
      {"more or fewer parts",
       [](PlanCertificate& c) {
         c.parts = {"part0", "part1", "part2"};
       }},
      {"'width' is not that of the proof",
       [](PlanCertificate& c) {
         c.numbers["width"] = {3, 5};
       }},
      {"'width' is not that of the proof", [](PlanCertificate& c) { c.numbers["width"] = {3}; }},
      {"'width' is missing", [](PlanCertificate& c) { c.numbers.clear(); }},
      {"'height' is no part of the proof", [](PlanCertificate& c) { c.numbers["height"] = {1}; }},
      {"is not positive", [](PlanCertificate& c) { c.margin = 0; }},
      {"full tolerance", [](PlanCertificate& c) { c.margin = 0.005; }},
      {"full tolerance", [](PlanCertificate& c) { c.full_tolerance = false; }},
      {"about parts as assembled",
       [this](PlanCertificate& c) {
         c.poses = {at({0, 0, 0}), at({0, 0, 0})};
       }},
  };
  for (const auto& [message, forge] : forgeries) {
    plan_ = honest;
    forge(plan_.certificates[0]);
    expect_problem(message);
  }
}

/// Without the checker of a third party's proof, the proof is neither right nor wrong.
TEST_F(CheckCertificates, OneWithoutItsProverIsNotChecked) {
  plan_.certificates.push_back(plan_.certificates[0]);
  plan_.certificates[1].kind = "rumour";
  PlanCheck c = check();
  EXPECT_TRUE(c.valid);
  EXPECT_EQ(c.certificates, 1u);
  EXPECT_EQ(c.checked_by_prover, 1u);
  ASSERT_EQ(c.not_checked.size(), 1u);
  EXPECT_NE(c.not_checked[0].find("certificate 1: there is no immobility prover 'rumour'"), std::string::npos);
  RunContext context;
  c = check_plan(plan_, assembly_, VerifyOptions{}, context);
  EXPECT_EQ(c.certificates, 0u);
  EXPECT_EQ(c.not_checked.size(), 2u);
  plan_.certificates[1].parts = {"part0", "part7"};
  expect_problem("is not in the assembly");
}

TEST_F(CheckCertificates, PartsStandWhereThePlanHasThemAtSomeTime) {
  plan_.unsolved.clear();
  PlanCertificate& c = plan_.certificates[0];
  c.kind = "placed";
  c.parts = {"part0", "part2"};
  for (const double x : {0.0, 0.8, 4.0}) {
    c.poses = {at({0, 0, 0}), at({x, 0, 0})};
    EXPECT_TRUE(check().valid) << x;
  }
  for (const Vec3& t : {Vec3(5, 0, 0), Vec3(0.8, 0.5, 0)}) {
    c.poses = {at({0, 0, 0}), at(t)};
    expect_problem("at no time of the plan");
  }
  c.poses = {at({0, 0, 0})};
  expect_problem("one pose for each part");
}

TEST_F(CheckCertificates, InfeasibleNeedsOneThatNamesThePart) {
  const Plan honest = plan_;
  plan_.unsolved[0].certificate.reset();
  expect_problem("'part0' is called infeasible without a certificate");
  plan_ = honest;
  plan_.unsolved[0].certificate = 3;
  expect_problem("there is no certificate 3");
  plan_ = honest;
  plan_.unsolved[0].part = "part2";
  expect_problem("'part2': its certificate is not about it");
  plan_ = honest;
  plan_.certificates[0].full_tolerance = false;
  plan_.certificates[0].margin = 0.005;
  expect_problem("'part0' is called infeasible without a certificate");
}

}  // namespace
}  // namespace dismantle
