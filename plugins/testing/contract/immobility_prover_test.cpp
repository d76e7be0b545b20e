// Laws of all immobility provers with default parameters.
#include "dismantle/immobility_prover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/executor.h"
#include "dismantle/part_memo.h"
#include "dismantle/testing/held_shapes.h"
#include "dismantle/testing/trials.h"
#include "dismantle/verification/check_certificate.h"
#include "small_assemblies.h"

namespace dismantle::contract {
namespace {

using shapes::Vec3;

/// An assembly and the groups of its parts that are queried.
struct Question {
  std::string name;
  Assembly assembly;
  std::vector<std::vector<PartId>> groups;  ///< the first part moves

  explicit Question(std::string n, Assembly a) : name(std::move(n)), assembly(std::move(a)) {
    const auto count = static_cast<PartId>(assembly.parts.size());
    std::vector<PartId> all;
    for (PartId i = 0; i < count; ++i) {
      all.push_back(i);
      for (PartId k = i + 1; k < count; ++k) groups.push_back({i, k});
    }
    if (count > 2) groups.push_back(all);
  }
};

std::size_t triangles_of(const Assembly& assembly) {
  std::size_t count = 0;
  for (const Part& part : assembly.parts) count += part.mesh->triangles.size();
  return count;
}

/// Assemblies whose parts all leave by contact-free motions, one after the other or several together; so no pair of
/// them holds each other, nor do all together.
std::vector<Question> separable() {
  std::vector<Question> questions;
  for (const samples::Sample& sample : samples::list()) {
    if (!sample.solvable || !sample.clean) continue;
    const auto parts = samples::make(sample.name);
    if (parts.size() > 4) continue;
    PrepareOptions options;
    RunContext context;
    PrepareReport report;
    Assembly assembly = prepare_assembly(parts, sample.name, "", options, context, report);
    // Provers take up to a minute on samples with more triangles, so these run only in the nightly tests.
    if (testing_support::nightly() || triangles_of(assembly) <= 300)
      questions.emplace_back(sample.name, std::move(assembly));
  }
  Rng rng(5);
  for (int i = 0; i < 4; ++i) {  // a block in a case with an open top
    const shapes::Cased c{{rng.uniform(0.4, 0.7), rng.uniform(0.3, 0.5), rng.uniform(0.3, 0.5)},
                          rng.uniform(0.005, 0.03),
                          rng.uniform(-0.02, 0),
                          rng.uniform(0.1, 0.2)};
    const Pose at = shapes::random_pose(rng, 2);
    questions.emplace_back("cased", shapes::assembly_of({shapes::moved(c.block(), at), shapes::moved(c.around(), at)}));
  }
  for (int i = 0; i < 4; ++i) {  // blocks side by side, in contact
    std::vector<Mesh> blocks;
    double x = 0;
    for (int k = 0; k < 3; ++k) {
      const double w = rng.uniform(0.2, 0.6);
      blocks.push_back(shapes::box({x, 0, 0}, {x + w, rng.uniform(0.2, 1), rng.uniform(0.2, 1)}));
      x += w;
    }
    questions.emplace_back("blocks", shapes::assembly_of(blocks));
  }
  return questions;
}

/// Assemblies with parts that hold each other, each in a different way.
std::vector<Question> inseparable() {
  std::vector<Question> questions;
  const Mesh ring = shapes::tube(0.4, 0.8, -0.1, 0.1, 48), disc = shapes::tube(0, 0.9, -0.05, 0.05, 48);
  questions.emplace_back("ring", shapes::assembly_of({ring, shapes::can(1, 0.6, 0.3, 0.3)}));
  questions.emplace_back("disc", shapes::assembly_of({disc, shapes::can_with_window(1, 0.6, 0.3, 0.3, 6)}));
  Assembly pinned =
      shapes::assembly_of({shapes::box({-2, -2, -0.5}, {2, 2, 0.5}), shapes::box({-0.3, -0.3, -1}, {0.3, 0.3, 1})});
  pinned.overlaps = {{0, 1, 0.05}};
  questions.emplace_back("pin", pinned);
  const shapes::Cased c{{0.5, 0.4, 0.4}, 0.01, 0.1, 0.15};
  questions.emplace_back("cased", shapes::assembly_of({c.block(), c.around()}));
  shapes::Keyed k;
  k.play = 0.002;
  questions.emplace_back("keyed", shapes::assembly_of({k.slab(), k.tray(), k.block()}));
  return questions;
}

class ImmobilityProverContract : public testing::TestWithParam<std::string> {
 protected:
  std::shared_ptr<const ImmobilityProver> prover() const { return registry().create<ImmobilityProver>(GetParam()); }

  static std::optional<Certificate> ask(const ImmobilityProver& prover, const Assembly& assembly,
                                        const std::vector<PartId>& group, double tolerance, double share,
                                        const RunContext& context) {
    const ProverTraits traits = prover.traits();
    if (group.size() < traits.min_parts || group.size() > traits.max_parts) return std::nullopt;
    PartMemo memo;
    return prover.prove(query(assembly, group, tolerance, share, memo), context);
  }

  /// The objection of the independent checker of the kind, or of the prover if there is no checker.
  std::string objection(Certificate certificate, const SeparationQuery& asked, const RunContext& context) const {
    certificate.kind = GetParam();
    const auto independent = independent_objection(certificate, asked, context);
    return independent ? *independent : prover()->objection(certificate, asked, context);
  }

  static SeparationQuery query(const Assembly& assembly, const std::vector<PartId>& group, double tolerance,
                               double share, PartMemo& memo) {
    SeparationQuery q{assembly, {{group.front(), Pose{}}}, {}, tolerance, share, memo};
    for (std::size_t i = 1; i < group.size(); ++i) q.fixed.push_back({group[i], Pose{}});
    return q;
  }
};

TEST_P(ImmobilityProverContract, NeverProvesPartsThatCanBeSeparated) {
  for (const Question& question : separable())
    for (const auto& group : question.groups)
      for (const double share : {0.5, 1.0}) {
        const auto found = ask(*prover(), question.assembly, group, 0.01, share, {});
        EXPECT_FALSE(found) << question.name << ": " << (found ? found->text : "");
      }
}

TEST_P(ImmobilityProverContract, StepsAsideForOpenParts) {
  for (Question& question : inseparable()) {
    for (Part& part : question.assembly.parts) {
      Mesh open = *part.mesh;
      open.triangles.pop_back();
      part.mesh = part.surface = std::make_shared<const Mesh>(std::move(open));
      part.open = true;
    }
    for (const auto& group : question.groups) {
      const auto found = ask(*prover(), question.assembly, group, 0.004, 0.5, {});
      EXPECT_FALSE(found) << question.name << ": " << (found ? found->text : "");
    }
  }
}

TEST_P(ImmobilityProverContract, SameCertificateAgainAndOnAnyNumberOfThreads) {
  for (const Question& question : inseparable())
    for (const auto& group : question.groups) {
      const auto once = ask(*prover(), question.assembly, group, 0.004, 0.5, {});
      for (const unsigned threads : {1U, 3U}) {
        RunContext context;
        context.threads = threads;
        if (threads > 1) context.executor = std::make_shared<Executor>(threads);
        const auto again = ask(*prover(), question.assembly, group, 0.004, 0.5, context);
        ASSERT_EQ(once.has_value(), again.has_value()) << question.name;
        if (!once) continue;
        EXPECT_EQ(once->parts, again->parts);
        EXPECT_EQ(once->numbers, again->numbers);
        EXPECT_EQ(once->text, again->text);
      }
    }
}

TEST_P(ImmobilityProverContract, ItsCertificatesHoldAndForgedOnesDoNot) {
  for (const Question& question : inseparable())
    for (const auto& group : question.groups) {
      const auto found = ask(*prover(), question.assembly, group, 0.004, 0.5, {});
      if (!found) continue;
      EXPECT_GE(found->parts.size(), 2U);
      for (const PartId id : found->parts) {
        EXPECT_NE(std::find(group.begin(), group.end(), id), group.end());
        EXPECT_NE(found->text.find(question.assembly.parts[id].name), std::string::npos) << found->text;
      }
      EXPECT_TRUE(found->poses.empty() || found->poses.size() == found->parts.size());
      EXPECT_EQ(found->poses.empty(), !prover()->traits().depends_on_poses);
      PartMemo memo;
      const SeparationQuery q = query(question.assembly, found->parts, 0.004, 0.5, memo);
      EXPECT_EQ(objection(*found, q, {}), "") << question.name;
      Certificate forged = *found;
      forged.numbers.clear();
      EXPECT_NE(objection(forged, q, {}), "") << question.name;
      // The same claim about parts side by side.
      std::vector<Mesh> apart;
      for (const PartId id : found->parts)
        apart.push_back(shapes::moved(*question.assembly.parts[id].mesh,
                                      shapes::shift(Vec3(10.0 * static_cast<double>(apart.size()), 0, 0))));
      const Assembly other = shapes::assembly_of(apart);
      forged = *found;
      for (std::size_t i = 0; i < forged.parts.size(); ++i) forged.parts[i] = static_cast<PartId>(i);
      PartMemo fresh;
      EXPECT_NE(objection(forged, query(other, forged.parts, 0.004, 0.5, fresh), {}), "") << question.name;
    }
}

TEST_P(ImmobilityProverContract, ACallThatIsToldToStopLeavesNothingBehind) {
  RunContext stopped;
  stopped.cancel.cancel();
  for (const Question& question : inseparable())
    for (const auto& group : question.groups) {
      const ProverTraits traits = prover()->traits();
      if (group.size() < traits.min_parts || group.size() > traits.max_parts) continue;
      const auto once = ask(*prover(), question.assembly, group, 0.004, 0.5, {});
      PartMemo memo;
      const SeparationQuery q = query(question.assembly, group, 0.004, 0.5, memo);
      const auto cut = prover()->prove(q, stopped);
      EXPECT_TRUE(!cut || once) << "what is proved in spite of it is true";
      EXPECT_EQ(prover()->prove(q, {}).has_value(), once.has_value()) << question.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Registered, ImmobilityProverContract, testing::ValuesIn(ids(PluginKind::immobility_prover)),
                         test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ImmobilityProverContract);

}  // namespace
}  // namespace dismantle::contract
