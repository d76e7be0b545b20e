// Parts that a snap fit holds are not searched for deeply where they may be forced.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "run_blocking.h"

namespace dismantle {
namespace {

/// Open above, with a lip on all four sides that covers the rim of a block of 2 x 2 x 1 in it, which has room of
/// `width` on each side of its axis.
Mesh case_with_lip(double lip, double width = 1) {
  Mesh made = shapes::box({-2, -2, -1}, {2, 2, 0});
  for (const auto& [z0, z1, inner] : {std::tuple(0.0, 1.0, width), std::tuple(1.0, 1.4, 1 - lip)}) {
    made = shapes::joined(made, shapes::box({-2, -2, z0}, {-inner, 2, z1}));
    made = shapes::joined(made, shapes::box({inner, -2, z0}, {2, 2, z1}));
    made = shapes::joined(made, shapes::box({-inner, -2, z0}, {inner, -inner, z1}));
    made = shapes::joined(made, shapes::box({-inner, inner, z0}, {inner, 2, z1}));
  }
  return made;
}

Mesh block() { return shapes::box({-1, -1, 0}, {1, 1, 1}); }

/// A block in a case, and a box beside them.
Assembly clipped(double lip, bool with_box = true) {
  std::vector<Mesh> parts{case_with_lip(lip), block()};
  if (with_box) parts.push_back(shapes::box({2, -2, -1}, {3, 2, 0}));
  return shapes::assembly_of(parts);
}

constexpr unsigned kNoLimit = 1000;  // stands for a search without a limit of its depth

/// Deepest search for each part.
std::map<PartId, unsigned> deepest_searches(const Assembly& assembly, ForceWhen force) {
  std::map<PartId, unsigned> deepest;
  const auto search = [&](const PathQuery& query, RunContext& context) {
    const unsigned depth = query.budget.max_depth == 0 ? kNoLimit : query.budget.max_depth;
    unsigned& most = deepest[query.scene.moving.front().part];
    most = std::max(most, depth);
    return fake::shallow(query, context);
  };
  RunOptions options;
  options.force = force;
  fake::take_apart(assembly, 1, options, search);
  return deepest;
}

unsigned most_of(const std::map<PartId, unsigned>& searches) {
  unsigned most = 0;
  for (const auto& [part, depth] : searches) most = std::max(most, depth);
  return most;
}

/// Several of them side by side.
Assembly clipped_row(unsigned count) {
  std::vector<Mesh> parts;
  for (unsigned k = 0; k < count; ++k)
    for (const Part& part : clipped(0.1, false).parts) {
      Mesh mesh = *part.mesh;
      for (Eigen::Vector3d& v : mesh.vertices) v.x() += 4.0 * k;
      parts.push_back(std::move(mesh));
    }
  return shapes::assembly_of(parts);
}

std::size_t searched_deeply(const std::map<PartId, unsigned>& searches) {
  return static_cast<std::size_t>(std::ranges::count_if(searches, [](const auto& s) { return s.second >= 2; }));
}

TEST(SnapFits, AFewDeepSearchesDecideForTheOthersIfPartsMayBeForced) {
  for (const unsigned count : {3u, 6u}) {
    EXPECT_LE(searched_deeply(deepest_searches(clipped_row(count), ForceWhen::last_resort)), 4u) << count;
    EXPECT_GT(searched_deeply(deepest_searches(clipped_row(count), ForceWhen::off)), 4u) << count;
  }
}

TEST(SnapFits, APairIsSearchedForToTheDepthOfFew) {
  EXPECT_EQ(most_of(deepest_searches(clipped(0.1), ForceWhen::last_resort)), BlockingParameters{}.snap_depth_of_few);
  EXPECT_EQ(most_of(deepest_searches(clipped(0.1), ForceWhen::off)), kNoLimit);
}

TEST(SnapFits, HoldAlsoWhatIsFreeWithoutThem) {
  // Two cases in one part, open in different directions: it leaves neither block in a straight line. Three of them.
  const Pose beside{{-6, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()))};
  std::vector<Mesh> parts;
  for (int k = 0; k < 3; ++k) {
    const Pose place{{0, 12.0 * k, 0}, Eigen::Quaterniond::Identity()};
    parts.push_back(
        shapes::moved(shapes::joined(case_with_lip(0.1), shapes::moved(case_with_lip(0.1), beside)), place));
    parts.push_back(shapes::moved(block(), place));
    parts.push_back(shapes::moved(block(), place * beside));
  }
  const Assembly made = shapes::assembly_of(parts);
  EXPECT_LE(searched_deeply(deepest_searches(made, ForceWhen::last_resort)), 4u);
  EXPECT_GT(searched_deeply(deepest_searches(made, ForceWhen::off)), 4u);
}

TEST(SnapFits, AreNoDeepCuts) { EXPECT_EQ(most_of(deepest_searches(clipped(0.8), ForceWhen::last_resort)), kNoLimit); }

TEST(SnapFits, FewPartsThatAreAllSearchedForAreLeftToForcedSteps) {
  // Two blocks in one part that is a case for both.
  const Pose beside{{4, 0, 0}, Eigen::Quaterniond::Identity()};
  const Assembly made =
      shapes::assembly_of({shapes::joined(case_with_lip(0.1), shapes::moved(case_with_lip(0.1), beside)), block(),
                           shapes::moved(block(), beside)});
  EXPECT_LE(most_of(deepest_searches(made, ForceWhen::last_resort)), BlockingParameters{}.snap_depth_of_few);
  EXPECT_GT(most_of(deepest_searches(made, ForceWhen::off)), BlockingParameters{}.snap_depth_of_few);
}

/// A square ring between heights, about the axis of z.
Mesh ring(double inner, double outer, double z0, double z1) {
  Mesh made = shapes::box({-outer, -outer, z0}, {-inner, outer, z1});
  made = shapes::joined(made, shapes::box({inner, -outer, z0}, {outer, outer, z1}));
  made = shapes::joined(made, shapes::box({-inner, -outer, z0}, {inner, -inner, z1}));
  return shapes::joined(made, shapes::box({-inner, inner, z0}, {inner, outer, z1}));
}

// A wheel on a shaft between a collar, over which it snaps, and a clip in a groove. The clip alone, with the wheel
// taken away, does not leave the shaft, and the wheel does without the clip: no search among all three is deep.
TEST(SnapFits, ASearchForThePairDecidesForWhatItHolds) {
  Mesh shaft = shapes::box({-1.1, -1.1, 0}, {1.1, 1.1, 1});
  shaft = shapes::joined(shaft, shapes::box({-1, -1, 1}, {1, 1, 3}));
  shaft = shapes::joined(shaft, shapes::box({-0.85, -0.85, 3}, {0.85, 0.85, 3.5}));
  shaft = shapes::joined(shaft, shapes::box({-1, -1, 3.5}, {1, 1, 4}));
  const Assembly made = shapes::assembly_of({shaft, ring(1, 3, 1, 3), ring(0.9, 1.5, 3, 3.5)});
  std::vector<std::size_t> deep;  // parts in the scenes of deep searches
  const auto search = [&](const PathQuery& query, RunContext& context) {
    const std::size_t parts = query.scene.moving.size() + query.scene.fixed.size();
    if (query.budget.max_depth == 0 || query.budget.max_depth >= BlockingParameters{}.snap_depth_of_few)
      deep.push_back(parts);
    if (const Pose up{{0, 0, 30}, Eigen::Quaterniond::Identity()}; parts == 2)
      if (PathResult straight = fake::shown(query, {{Pose{}}, {up}}); straight.path()) return straight;
    return fake::shallow(query, context);
  };
  for (const bool forced : {true, false}) {
    deep.clear();
    RunOptions options;
    options.force = forced ? ForceWhen::last_resort : ForceWhen::off;
    fake::take_apart(made, 1, options, search);
    EXPECT_EQ(std::ranges::count(deep, 3u) > 0, !forced);
    if (forced) {
      EXPECT_GE(std::ranges::count(deep, 2u), 1);
    }
  }
}

TEST(SnapFits, DoNotCountInAnAssemblyOfTwoParts) {
  EXPECT_EQ(most_of(deepest_searches(clipped(0.1, false), ForceWhen::last_resort)), kNoLimit);
}

TEST(SnapFits, CountInAnAssemblyOfTwoPartsThatArePressedTogether) {
  // Twice as deep in the lip as when assembled, and more.
  for (const auto& [lip, count] : {std::pair(0.1, true), std::pair(0.2, false)}) {
    const Assembly pressed = shapes::assembly_of({case_with_lip(lip, 0.92), block()}, {{0, 1, 0.08}});
    const unsigned limited = BlockingParameters{}.snap_depth_of_few;
    EXPECT_EQ(most_of(deepest_searches(pressed, ForceWhen::last_resort)), count ? limited : kNoLimit) << lip;
    EXPECT_EQ(most_of(deepest_searches(pressed, ForceWhen::off)), kNoLimit) << lip;
  }
}

}  // namespace
}  // namespace dismantle
