// Groups, poses, times and the exploded view of random plans obey their laws.
#include <gtest/gtest.h>

#include "dismantle/errors.h"
#include "dismantle/plan_io/explode.h"
#include "dismantle/plan_io/plan_history.h"
#include "dismantle/testing/shapes.h"
#include "random_plan.h"
#include "steps/timeline.h"

namespace dismantle {
namespace {

Assembly random_boxes(Rng& rng, std::size_t count) {
  std::vector<std::pair<std::string, Mesh>> parts;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d lo(rng.uniform(-5, 5), rng.uniform(-5, 5), rng.uniform(-5, 5));
    const Eigen::Vector3d size(rng.uniform(0.1, 6), rng.uniform(0.1, 6), rng.uniform(0.1, 6));
    parts.emplace_back("p" + std::to_string(i), shapes::box(lo, lo + size));
  }
  return assembly_of_meshes(parts, rng.uniform(0.1, 10), {1, 2, 3});
}

template <class Law>
void for_random_plans(Law law) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng(seed);
    const Assembly assembly = random_boxes(rng, 2 + rng.below(11));
    law(assembly, random_plan(assembly, rng));
    if (testing::Test::HasFailure()) return;
  }
}

TEST(PlanHistory, GroupsAndPosesAreThoseAfterEachStep) {
  for_random_plans([](const Assembly&, const RandomPlan& truth) {
    const PlanHistory history(truth.plan);
    ASSERT_EQ(history.steps() + 1, truth.groups.size());
    for (std::size_t done = 0; done <= history.steps(); ++done) {
      std::set<PartGroup> groups;
      for (std::size_t g = 0; g < history.groups(); ++g) {
        const auto members = history.members(g, done);
        if (members.empty()) continue;
        EXPECT_TRUE(groups.emplace(members.begin(), members.end()).second);
        for (const std::size_t i : members) EXPECT_EQ(history.group_of(i, done), g);
      }
      EXPECT_EQ(groups, truth.groups[done]);
      for (std::size_t i = 0; i < history.parts(); ++i) EXPECT_EQ(history.pose_of(i, done), truth.poses[done][i]);
    }
  });
}

TEST(PlanHistory, AStepSplitsAGroupIntoTheRestAndWhatLeaves) {
  for_random_plans([](const Assembly&, const RandomPlan& truth) {
    const PlanHistory history(truth.plan);
    std::set<std::size_t> left;
    std::size_t rank = 0;
    for (std::size_t s = 0; s < history.steps(); ++s) {
      std::size_t leaving = 0;
      for (const GroupSplit& split : history.splits(s)) {
        ASSERT_FALSE(split.out.empty());
        std::size_t parts = history.members(split.from, s + 1).size();
        EXPECT_GT(parts, 0u);
        for (const std::size_t group : split.out) {
          EXPECT_TRUE(history.members(group, s).empty());
          leaving += history.members(group, s + 1).size();
          parts += history.members(group, s + 1).size();
        }
        EXPECT_EQ(parts, history.members(split.from, s).size());
      }
      EXPECT_EQ(history.splits(s).empty(), truth.plan.disassembly[s].separates.empty());
      EXPECT_EQ(history.leaving(s).size(), leaving);
      std::set<std::size_t> ranks;
      for (const std::size_t i : history.leaving(s))
        if (left.insert(i).second) ranks.insert(history.rank(i).value());
      for (const std::size_t r : ranks) EXPECT_EQ(r, rank++) << "who leaves first has the lower rank";
    }
    EXPECT_EQ(history.leavers(), left.size());
    for (std::size_t i = 0; i < history.parts(); ++i) EXPECT_EQ(history.rank(i).has_value(), left.contains(i));
  });
}

TEST(PlanHistory, APartIsOutWhenItsGroupIsWhatItIsAtTheEnd) {
  for_random_plans([](const Assembly&, const RandomPlan& truth) {
    const PlanHistory history(truth.plan);
    const auto& remaining = truth.plan.remaining;
    for (std::size_t i = 0; i < history.parts(); ++i) {
      const std::size_t last = history.group_of(i, history.steps());
      const auto group_after = [&](std::size_t done) {
        const auto members = history.members(history.group_of(i, done), done);
        return PartGroup(members.begin(), members.end());
      };
      const PartGroup group = group_after(history.steps());
      const bool stays = last == 0 || (group.size() > 1 && std::ranges::any_of(group, [&](std::size_t k) {
                                         return std::ranges::count(remaining, truth.plan.assembly.parts[k].name) > 0;
                                       }));
      ASSERT_EQ(history.out_in(i).has_value(), !stays);
      if (stays) continue;
      EXPECT_EQ(group_after(*history.out_in(i) + 1), group);
      EXPECT_NE(group_after(*history.out_in(i)), group);
    }
  });
}

TEST(PlanHistory, WhenAllIsNamedWhatDoesNotMoveStays) {
  Plan plan;
  for (const char* name : {"a", "b", "c"}) plan.assembly.parts.push_back({0, name, "x", {}, {}});
  PlanStep step;
  step.moves = {{"a", {Pose{}, Pose{}}}, {"b", {Pose{}, Pose{}}}};
  step.separates = {{"a", "b"}, {"c"}};
  plan.disassembly = {step};
  const PlanHistory history(plan);
  EXPECT_EQ(history.members(0, 1).size(), 1u);
  EXPECT_EQ(history.members(0, 1).front(), 2u);
  EXPECT_EQ(history.rank(2), std::nullopt) << "it did not leave";
  plan.disassembly[0].separates = {{"ghost"}};
  EXPECT_THROW(PlanHistory{plan}, InputError);
}

TEST(Timeline, StepsFollowEachOtherAndEveryPoseHasItsTime) {
  for_random_plans([](const Assembly& assembly, const RandomPlan& truth) {
    for (const auto* steps : {&truth.plan.disassembly, &truth.plan.assembly_steps}) {
      const bool apart = steps == &truth.plan.disassembly;
      const StepUps ups = apart ? disassembly_ups(truth.plan) : assembly_ups(truth.plan);
      const Timeline line = timeline(*steps, assembly, ups);
      float before = 0;
      std::optional<std::size_t> last;
      for (const StepTime& step : line.steps) {
        EXPECT_GT(step.begin, before + 0.29F) << "a pause";
        EXPECT_EQ(step.begin > before + 1.19F, last && ups[*last] != ups[step.index]) << "time to turn the assembly";
        last = step.index;
        EXPECT_GE(step.end - step.begin, 1 - 1e-4F);
        EXPECT_LE(step.end - step.begin, 3 + 1e-4F);
        ASSERT_EQ(step.pose_times.size(), (*steps)[step.index].moves.front().poses.size());
        EXPECT_EQ(step.begin, step.pose_times.front());
        EXPECT_EQ(step.end, step.pose_times.back()) << "whether anything moves or not";
        before = step.end;
      }
      EXPECT_EQ(line.duration > before, !line.steps.empty());
      for (const Track& track : line.tracks) {
        std::size_t keys = 1;
        for (const StepTime& step : line.steps)
          if (std::ranges::find(step.parts, track.part) != step.parts.end()) keys += step.pose_times.size();
        EXPECT_EQ(track.keys.size(), keys);
        for (std::size_t k = 1; k < keys; ++k) EXPECT_LT(track.keys[k - 1].time, track.keys[k].time);
        EXPECT_EQ(track.keys.back().time, line.duration);
      }
    }
  });
  EXPECT_EQ(timeline({}, Assembly{}, {}).duration, 0);
}

TEST(Explode, BoxesOfPartsThatComeApartAreClearOfEachOther) {
  for_random_plans([](const Assembly& assembly, const RandomPlan& truth) {
    const PlanHistory history(truth.plan);
    const auto offsets = exploded_offsets(truth.plan, assembly);
    const auto box = [&](std::size_t i) {
      Aabb out;
      for (const auto& v : assembly.parts[i].mesh->vertices)
        out.extend(assembly.normalization.to_input(v) + offsets[i]);
      return out;
    };
    for (std::size_t i = 0; i < offsets.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        if (history.group_of(i, history.steps()) == history.group_of(j, history.steps())) {
          EXPECT_EQ(offsets[i], offsets[j]) << "what stays together does not move apart";
          continue;
        }
        const Aabb a = box(i), b = box(j);
        EXPECT_TRUE(((a.lo - b.hi).array() > -1e-9).any() || ((b.lo - a.hi).array() > -1e-9).any()) << i << " " << j;
      }
  });
}

TEST(Explode, APartGoesWhereThePlanTakesIt) {
  std::vector<std::pair<std::string, Mesh>> parts;
  for (int i = 0; i < 3; ++i)
    parts.emplace_back(std::string(1, char('a' + i)), shapes::box({1.0 * i, 0, 0}, {i + 1.0, 1, 1}));
  const Assembly assembly = assembly_of_meshes(parts, 1, {0, 0, 0});
  Plan plan;
  plan.assembly = described(assembly);
  PlanStep step;
  step.separates = {{"c"}};
  const Pose away{{0, 5, 0}, Eigen::Quaterniond::Identity()};
  step.moves = {{"c", {Pose{}, away}}};
  plan.disassembly = {step};
  const auto direction = [&] { return Eigen::Vector3d(exploded_offsets(plan, assembly)[2].normalized()); };
  EXPECT_EQ(direction(), Eigen::Vector3d::UnitY());
  // The same motion, seen from the other side.
  plan.disassembly[0].moves = {{"a", {Pose{}, away}}, {"b", {Pose{}, away}}};
  EXPECT_EQ(direction(), -Eigen::Vector3d::UnitY());
}

}  // namespace
}  // namespace dismantle
