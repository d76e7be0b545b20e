// Relations do not depend on the thread that computes them, on the order of questions, or on hints.
#include "blocking_graph/relations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "dismantle/testing/barred_shaft.h"
#include "dismantle/testing/fake_planning.h"

namespace dismantle::blocking {
namespace {

/// Only states the verifier's tolerance, and what its planners share.
class TolerantOracle final : public PathOracle {
 public:
  explicit TolerantOracle(PartMemo* memo = nullptr) : memo_(memo) {}
  const AttemptResult& attempt(const Attempt&, RunContext&) override { throw std::logic_error("not to be asked"); }
  void prefetch(std::span<const Attempt>, RunContext&) override {}
  const AttemptResult& propose(const Attempt&, const Path&, RunContext&) override {
    throw std::logic_error("not to be asked");
  }
  OracleCounts counts() const override { return {}; }
  double tolerance() const override { return 0.01; }
  PartMemo* memo() override { return memo_; }

 private:
  PartMemo* memo_;
};

TEST(Relations, OfOnePlannerAreNotComputedAgainByTheNext) {
  const Assembly assembly = fake::tube_with_blocks(4);
  const Directions directions = directions_of(assembly);
  const Orientations orientations;
  const auto ask_all = [&](const PairSweep& sweep) {
    Relations relations(sweep, directions, orientations, nullptr);
    std::vector<bool> answers;
    for (PartId a = 0; a < assembly.parts.size(); ++a)
      for (PartId b = 0; b < assembly.parts.size(); ++b)
        for (std::size_t d = 0; a != b && d < directions.all.size(); ++d)
          answers.push_back(relations.blocks({a, b, d, Eigen::Vector3d::Zero(), 0, 0}));
    return answers;
  };
  PartMemo memo;
  TolerantOracle sharing(&memo), other;
  const PairSweep first(assembly, sharing), second(assembly, sharing), apart(assembly, other);
  const auto answers = ask_all(first);
  const std::uint64_t computed = SharedAnswers::of(first).computed();
  EXPECT_GT(computed, 0U);
  EXPECT_EQ(ask_all(second), answers);
  EXPECT_EQ(SharedAnswers::of(second).computed(), computed);
  EXPECT_EQ(SharedAnswers::of(apart).computed(), 0U);
  EXPECT_EQ(ask_all(apart), answers);
}

TEST(Relations, AreTheSameWhoeverHelps) {
  for (const Assembly& assembly : {fake::tube_with_blocks(4), barred_shaft()}) {
    TolerantOracle oracle;
    const PairSweep sweep(assembly, oracle);
    const Directions directions = directions_of(assembly);
    std::vector<Pair> pairs;
    for (PartId a = 0; a < assembly.parts.size(); ++a)
      for (PartId b = 0; b < assembly.parts.size(); ++b)
        for (std::size_t d = 0; a != b && d < directions.all.size(); ++d)
          pairs.push_back({a, b, d, Eigen::Vector3d::Zero(), 0, 0});
    const Orientations orientations;
    Relations alone(sweep, directions, orientations, nullptr);
    EXPECT_FALSE(alone.works_ahead());
    std::size_t blocked = 0;
    for (const Pair& p : pairs) blocked += alone.blocks(p);
    EXPECT_GT(blocked, 0u);
    EXPECT_LT(blocked, pairs.size());
    Rng rng(6);
    for (const unsigned threads : {1U, 2U, 4U})
      for (int trial = 0; trial < 5; ++trial) {
        const auto executor = std::make_shared<Executor>(threads);
        const PairSweep own(assembly, oracle);  // knows no answers yet
        Relations helped(own, directions, orientations, executor);
        EXPECT_EQ(helped.works_ahead(), threads > 1);
        for (int round = 0; round < 10; ++round) {
          std::vector<std::vector<Pair>> lines(rng.below(6));
          for (auto& line : lines)
            for (std::uint64_t k = rng.below(5); k-- > 0;) line.push_back(pairs[rng.below(pairs.size())]);
          if (helped.works_ahead()) helped.hint(lines);
          std::vector<Pair> asked;
          for (std::uint64_t k = rng.below(20); k-- > 0;) asked.push_back(pairs[rng.below(pairs.size())]);
          const std::uint64_t before = helped.computed();
          helped.compute(asked);
          EXPECT_LE(helped.computed(), before + asked.size()) << "what was found ahead is not counted";
          for (const Pair& p : asked) {
            ASSERT_TRUE(helped.known(p));
            ASSERT_EQ(helped.blocks(p), alone.blocks(p));
          }
        }
      }
  }
}

/// Copies of a few angular shapes, at random poses: half of the poses are turned by quarters.
Assembly copies_of_shapes(Rng& rng, std::size_t count) {
  std::vector<std::pair<std::string, std::vector<fake::Box>>> parts;
  for (std::size_t k = 0; k < count; ++k)
    parts.push_back(
        {"part" + std::to_string(k), {{{0, 0, 0}, {2, 1, 1}}, {{0, 1.01, 0}, {1, k % 2 == 0 ? 2.0 : 3.0, 1}}}});
  Assembly assembly = fake::assembly_of(parts);
  for (Part& part : assembly.parts) {
    Pose pose{{2.5 * std::floor(rng.uniform(0, 3)), 2.5 * std::floor(rng.uniform(0, 3)), rng.uniform(0, 9)}, {}};
    const double quarter = std::numbers::pi / 2;
    const double angle = part.id % 2 == 0 ? quarter * static_cast<double>(rng.below(4)) : rng.uniform(0, 6);
    pose.q = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
    Mesh mesh = *part.mesh;
    for (auto& v : mesh.vertices) v = pose * v;
    part.mesh = part.surface = std::make_shared<const Mesh>(mesh);
  }
  return assembly;
}

TEST(Relations, OfEqualPartsAreThoseOfThePartsThemselves) {
  Rng rng(11);
  std::size_t compared = 0, blocked = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const Assembly assembly = copies_of_shapes(rng, 8);
    TolerantOracle oracle;
    const PairSweep sweep(assembly, oracle);
    EXPECT_EQ(sweep.shape(2).original, 0u);
    EXPECT_EQ(sweep.shape(7).original, 1u);
    const Directions directions = directions_of(assembly);
    const Orientations orientations;
    Relations relations(sweep, directions, orientations, nullptr);
    for (PartId a = 0; a < assembly.parts.size(); ++a)
      for (PartId b = 0; b < assembly.parts.size(); ++b)
        for (std::size_t d = 0; a != b && d < directions.all.size(); ++d) {
          const Pair pair{a, b, d, Eigen::Vector3d::Zero(), 0, 0};
          if (relations.far(pair)) continue;
          const Eigen::Vector3d out = (relations.distance_past(pair) + 0.001) * directions.all[d];
          const bool blocks = !sweep.passes(a, b, Pose{}, {Pose{}, Pose{out, Eigen::Quaterniond::Identity()}});
          EXPECT_EQ(relations.blocks(pair), blocks) << trial << ": " << a << " past " << b << ", direction " << d;
          ++compared;
          blocked += blocks ? 1 : 0;
        }
  }
  EXPECT_GT(compared, 500u);
  EXPECT_GT(blocked, 100u);
  EXPECT_LT(blocked, compared);
}

/// A pin is stuck deep in the boss of a plate: that depth is allowed everywhere in the plate, since it is thinner, but
/// only where the pin is. On its way out the arm of the pin would cut through the plate beside the boss.
TEST(Relations, DeepOverlapsAreAllowedWhereTheyAreWhenAssembled) {
  Rng rng(12);
  for (int trial = 0; trial < 20; ++trial) {
    const double plate = rng.uniform(0.3, 0.6), deep = rng.uniform(0.45, 0.6), width = rng.uniform(0.2, 0.4);
    const double x = rng.uniform(-2, 2), y = rng.uniform(-2, 2), arm = rng.uniform(1, 2);
    Assembly assembly =
        fake::assembly_of({{"plate", {{{-6, -6, 0}, {6, 6, plate}}, {{x - 1, y - 1, 0}, {x + 1, y + 1, 3}}}},
                           {"pin",
                            {{{x - width, y - width, -2}, {x + width, y + width, deep}},
                             {{x + 1.2, y, 4}, {x + 1.2 + arm, y + 1, 4.5}}}}});
    InitialOverlap overlap{0, 1, deep, OverlapPlace{}};
    overlap.place->region.extend(Eigen::Vector3d(x - width, y - width, 0));
    overlap.place->region.extend(Eigen::Vector3d(x + width, y + width, deep));
    assembly.overlaps = {overlap};
    TolerantOracle oracle;
    const PairSweep sweep(assembly, oracle);
    const Directions directions = directions_of(assembly);
    const Orientations orientations;
    Relations relations(sweep, directions, orientations, nullptr);
    for (std::size_t d = 0; d < directions.all.size(); ++d) {
      const double up = directions.all[d].z();
      if (std::abs(up) < 0.99) continue;
      const bool blocked = relations.blocks({1, 0, d, Eigen::Vector3d::Zero(), 0, 0});
      EXPECT_TRUE(blocked) << trial << ", " << up;
      EXPECT_EQ(relations.blocks({0, 1, Directions::opposite(d), Eigen::Vector3d::Zero(), 0, 0}), blocked) << trial;
    }
    const std::vector<Pose> out{Pose{}, Pose{{0, 0, -8}, Eigen::Quaterniond::Identity()}};
    EXPECT_TRUE(sweep.leaves_region(1, 0, Pose{}, out));
    EXPECT_FALSE(sweep.passes(1, 0, Pose{}, out));
    EXPECT_TRUE(sweep.passes(1, 0, Pose{}, out, deep)) << "without the region this shows nothing";
  }
}

}  // namespace
}  // namespace dismantle::blocking
