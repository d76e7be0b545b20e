// Relations do not depend on the thread that computes them, on the order of questions, or on hints.
#include "blocking_graph/relations.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <vector>

#include "dismantle/testing/barred_shaft.h"
#include "dismantle/testing/fake_planning.h"

namespace dismantle::blocking {
namespace {

/// Only states the verifier's tolerance.
class TolerantOracle final : public PathOracle {
 public:
  const AttemptResult& attempt(const Attempt&, RunContext&) override { throw std::logic_error("not to be asked"); }
  void prefetch(std::span<const Attempt>, RunContext&) override {}
  const AttemptResult& propose(const Attempt&, const Path&, RunContext&) override {
    throw std::logic_error("not to be asked");
  }
  OracleCounts counts() const override { return {}; }
  double tolerance() const override { return 0.01; }
};

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
        Relations helped(sweep, directions, orientations, executor);
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

}  // namespace
}  // namespace dismantle::blocking
