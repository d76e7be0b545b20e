#include "identical_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::checks {
namespace {

/// Parts by letter: parts with the same letter are copies of one block, turned and displaced at random.
Assembly parts_of(const std::string& letters, Rng& rng) {
  Assembly assembly;
  for (const char letter : letters) {
    Mesh mesh = shapes::box({0, 0, 0}, {1, 2, 1 + 0.25 * (letter - 'a')});
    const Pose pose{{rng.normal(), rng.normal(), rng.normal()},
                    rotation_from_vector({rng.normal(), rng.normal(), rng.normal()})};
    for (auto& v : mesh.vertices) v = pose * v;
    Part part;
    part.id = static_cast<PartId>(assembly.parts.size());
    part.name = letter + std::to_string(part.id);
    part.mesh = std::make_shared<const Mesh>(std::move(mesh));
    assembly.parts.push_back(std::move(part));
  }
  return assembly;
}

/// The sum over an assembly in which the parts are put in in this order, one by one, onto a base of its own shape.
double cost(const IdenticalParts& check, const std::string& order, Rng& rng) {
  const Assembly assembly = parts_of("z" + order, rng);
  std::vector<PlacedPart> placed;
  for (const Part& p : assembly.parts) placed.push_back({p.id, Pose{}});
  const std::span<const PlacedPart> all(placed);
  double sum = 0;
  std::optional<StepQuestion> previous;
  for (std::size_t k = 1; k < all.size(); ++k) {
    StepQuestion question{assembly, all.subspan(k, 1), all.first(k)};
    question.previous = previous ? &*previous : nullptr;
    const StepVerdict v = check.judge(question, RunContext{});
    EXPECT_EQ(v.reason.empty(), v.cost == 0);
    sum += v.cost;
    question.previous = nullptr;
    previous.emplace(question);
  }
  return sum;
}

/// Series of equal letters without the first one of each letter.
double interruptions(const std::string& order) {
  std::array<int, 26> series{};
  for (std::size_t k = 0; k < order.size(); ++k)
    if (k == 0 || order[k] != order[k - 1]) ++series[static_cast<std::size_t>(order[k] - 'a')];
  double sum = 0;
  for (const int n : series) sum += std::max(0, n - 1);
  return sum;
}

TEST(IdenticalParts, CountsInterruptions) {
  Rng rng(3);
  const IdenticalParts check;
  EXPECT_EQ(cost(check, "aaabbb", rng), 0);
  EXPECT_EQ(cost(check, "aabbba", rng), 1);
  EXPECT_EQ(cost(check, "ababab", rng), 4);
  EXPECT_EQ(cost(check, "abcd", rng), 0) << "all parts differ";
}

// Law: the sum over any order is the number of interruptions.
TEST(IdenticalParts, TheSumIsTheNumberOfInterruptions) {
  Rng rng(11);
  const IdenticalParts check;
  for (int round = 0; round < 60; ++round) {
    std::string order;
    for (auto n = 1 + rng.below(9); n > 0; --n) order += static_cast<char>('a' + rng.below(3));
    EXPECT_EQ(cost(check, order, rng), interruptions(order)) << order;
  }
}

TEST(IdenticalParts, MirrorImagesDiffer) {
  Rng rng(2);
  Assembly assembly = parts_of("zba", rng);
  Mesh wedge = shapes::box({0, 0, 0}, {1, 2, 3});
  wedge.vertices.back() += Eigen::Vector3d(0.5, 0.25, 0.125);
  Mesh mirrored = wedge;
  for (auto& v : mirrored.vertices) v.x() = -v.x();
  assembly.parts[0].mesh = std::make_shared<const Mesh>(wedge);
  const std::vector<PlacedPart> all{{0, Pose{}}, {1, Pose{}}, {2, Pose{}}};
  const std::span<const PlacedPart> placed(all);
  const StepQuestion previous{assembly, placed.subspan(1, 1), placed.first(1)};
  const auto cost_with = [&](const Mesh& mesh) {
    assembly.parts[2].mesh = std::make_shared<const Mesh>(mesh);
    StepQuestion question{assembly, placed.subspan(2, 1), placed.first(2)};
    question.previous = &previous;
    return IdenticalParts().judge(question, RunContext{}).cost;
  };
  EXPECT_EQ(cost_with(wedge), 1);
  EXPECT_EQ(cost_with(mirrored), 0);
}

// Standard parts that were cut into other triangles are equal parts for people.
TEST(IdenticalParts, StandardPartsOfOtherTrianglesAreEqual) {
  Assembly assembly = shapes::assembly_of(
      {shapes::box({0, 0, 0}, {1, 1, 1}), shapes::tube(1, 2, 0, 4, 48), shapes::tube(1, 2, 0, 4, 64)});
  const std::vector<PlacedPart> all{{1, Pose{}}, {0, Pose{}}, {2, Pose{}}};
  const std::span<const PlacedPart> placed(all);
  const auto cost = [&](const char* kind, const char* other) {
    assembly.parts[1].kind = PartKind{kind};
    assembly.parts[2].kind = PartKind{other};
    const StepQuestion previous{assembly, placed.subspan(1, 1), placed.first(1)};
    StepQuestion question{assembly, placed.subspan(2, 1), placed.first(2)};
    question.previous = &previous;
    return IdenticalParts().judge(question, RunContext{}).cost;
  };
  EXPECT_EQ(cost("pin", "pin"), 1);
  EXPECT_EQ(cost("pin", "spacer"), 0);
  EXPECT_EQ(cost("other", "other"), 0) << "no standard part";
}

TEST(IdenticalParts, GroupsAreComparedAsSetsOfShapes) {
  Rng rng(4);
  const Assembly assembly = parts_of("abcba", rng);  // {0, 1} and {3, 4} are equal groups
  const std::vector<PlacedPart> all{{3, Pose{}}, {4, Pose{}}, {2, Pose{}}, {0, Pose{}}, {1, Pose{}}};
  const std::span<const PlacedPart> placed(all);
  const StepQuestion other{assembly, placed.subspan(2, 1), placed.first(2)};
  const StepQuestion equal{assembly, placed.first(2), placed.subspan(2, 1)};
  StepQuestion question{assembly, placed.subspan(3, 2), placed.first(3)};
  question.previous = &other;
  EXPECT_EQ(IdenticalParts().judge(question, RunContext{}).cost, 1);
  question.previous = &equal;
  EXPECT_EQ(IdenticalParts().judge(question, RunContext{}).cost, 0);
}

// Law: with `another_way`, the second of two equal parts costs it exactly when its direction is neither that of the
// first in the world nor the same as seen from the parts; without it, nothing.
TEST(IdenticalParts, EqualPartsGoInTheSameWay) {
  Rng rng(8);
  for (int round = 0; round < 100; ++round) {
    const Pose turn{{rng.normal(), rng.normal(), rng.normal()}, rotation_from_vector({0.5 + rng.uniform(), 0.5, 0.7})};
    Mesh block = shapes::box({0, 0, 0}, {1, 2, 3});
    const Assembly assembly =
        shapes::assembly_of({shapes::box({0, 0, 0}, {5, 5, 5}), block, shapes::moved(block, turn)});
    const std::vector<PlacedPart> all{{0, Pose{}}, {1, Pose{}}, {2, Pose{}}};
    const std::span<const PlacedPart> placed(all);
    const Eigen::Vector3d first = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    const StepQuestion previous{assembly, placed.subspan(1, 1), placed.first(1), first};
    const auto cost = [&](const Eigen::Vector3d& direction, double another_way) {
      StepQuestion question{assembly, placed.subspan(2, 1), placed.first(2), direction};
      question.previous = &previous;
      const StepVerdict v = IdenticalParts({another_way}).judge(question, RunContext{});
      EXPECT_EQ(v.reason.empty(), v.cost == 0);
      return v.cost;
    };
    EXPECT_EQ(cost(first, 0.25), 0);
    EXPECT_EQ(cost(turn.q * first, 0.25), 0);
    EXPECT_EQ(cost(first.unitOrthogonal(), 0), 0);
    const Eigen::Vector3d other = first.cross(turn.q * first);
    if (other.norm() < 0.3) continue;
    EXPECT_EQ(cost(other.normalized(), 0.25), 0.25);
  }
}

TEST(IdenticalParts, RemembersTheDirectionOnlyIfItCounts) {
  EXPECT_FALSE(IdenticalParts().traits().remembers_direction);
  EXPECT_TRUE(IdenticalParts({.another_way = 1}).traits().remembers_direction);
}

}  // namespace
}  // namespace dismantle::checks
