// Groups and poses after each step of a disassembly, against a replay of all steps from the start.
#include "dismantle/disassembly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "dismantle/part_set.h"
#include "dismantle/run_context.h"

namespace dismantle {
namespace {

/// The state after some steps, computed anew from the start.
struct Replayed {
  std::vector<Pose> pose;
  std::vector<std::set<PartId>> groups;

  Replayed(const Disassembly& done, std::size_t start_groups, std::size_t count) : pose(done.parts()) {
    groups.resize(start_groups);
    for (PartId id = 0; id < done.parts(); ++id) {
      pose[id] = done.pose(id, 0);
      if (done.group(id, 0) != Disassembly::kAbsent) groups[done.group(id, 0)].insert(id);
    }
    for (std::size_t k = 0; k < count; ++k) {
      const DisassemblyStep& step = done.steps()[k];
      groups.emplace_back();
      for (std::size_t i = 0; i < step.parts.size(); ++i) {
        pose[step.parts[i]] = step.path->back()[i];
        if (step.placement || (step.released && *step.released != step.parts[i])) continue;
        for (auto& group : groups) group.erase(step.parts[i]);
        groups.back().insert(step.parts[i]);
      }
    }
  }
};

/// A step that some parts of a group can make: they leave, move and stay, or one of them leaves.
DisassemblyStep any_step(const Disassembly& done, Rng& rng) {
  std::vector<std::vector<PartId>> open;
  for (const auto& group : done.groups())
    if (group.size() > 1) open.push_back(group);
  const std::vector<PartId>& group = open[rng.below(open.size())];
  DisassemblyStep step;
  while (step.parts.empty() || step.parts.size() == group.size()) {
    step.parts.clear();
    for (const PartId id : group)
      if (rng.below(2) == 0) step.parts.push_back(id);
  }
  step.placement = rng.below(4) == 0;
  if (!step.placement && step.parts.size() > 1 && rng.below(3) == 0)
    step.released = step.parts[rng.below(step.parts.size())];
  Trace path(2);
  for (const PartId id : step.parts) {
    path[0].push_back(done.pose(id));
    path[1].push_back({Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()), Eigen::Quaterniond::Identity()});
  }
  step.path = std::make_shared<const Trace>(std::move(path));
  return step;
}

bool has_open_group(const Disassembly& done) {
  return std::any_of(done.groups().begin(), done.groups().end(), [](const auto& group) { return group.size() > 1; });
}

/// Some parts in one or two groups, at any poses; a few are absent.
std::vector<std::vector<PlacedPart>> any_start(std::size_t parts, Rng& rng) {
  std::vector<std::vector<PlacedPart>> groups(1 + rng.below(2));
  for (PartId id = 0; id < parts; ++id)
    if (rng.below(6) != 0)
      groups[rng.below(groups.size())].push_back({id, Pose{{rng.normal(), 0, 0}, Eigen::Quaterniond::Identity()}});
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  if (groups.empty()) groups.push_back({{0, Pose{}}});
  return groups;
}

TEST(Disassembly, KnowsGroupsAndPosesAfterEachStep) {
  Rng rng(3);
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t parts = 2 + rng.below(8);
    const auto start = any_start(parts, rng);
    Disassembly done = trial % 2 == 0 ? Disassembly(parts) : Disassembly(parts, start);
    Disassembly follower = done;
    const std::size_t start_groups = done.start_groups();
    while (has_open_group(done) && done.steps().size() < 20) {
      if (!done.steps().empty() && rng.below(5) == 0) done.pop();
      done.add(any_step(done, rng));
      follower.follow(done);
      for (std::size_t k = 0; k <= done.steps().size(); ++k) {
        const Replayed known(done, start_groups, k);
        for (PartId id = 0; id < parts; ++id) {
          EXPECT_EQ(done.pose(id, k), known.pose[id]);
          EXPECT_EQ(follower.pose(id, k), known.pose[id]);
          const std::size_t group = done.group(id, k);
          if (group != Disassembly::kAbsent) {
            EXPECT_TRUE(known.groups.at(group).contains(id));
          }
        }
      }
      const Replayed now(done, start_groups, done.steps().size());
      ASSERT_EQ(done.groups().size(), now.groups.size());
      for (std::size_t g = 0; g < now.groups.size(); ++g)
        EXPECT_EQ(done.groups()[g], std::vector<PartId>(now.groups[g].begin(), now.groups[g].end()));
      EXPECT_EQ(follower.groups(), done.groups());
    }
  }
}

TEST(Disassembly, RefusesStepsThatAreNotPossible) {
  const auto step = [](std::vector<PartId> parts) {
    DisassemblyStep made;
    made.path = std::make_shared<const Trace>(Trace(2, std::vector<Pose>(parts.size())));
    made.parts = std::move(parts);
    return made;
  };
  Disassembly done(4);
  EXPECT_THROW(done.add(step({})), std::logic_error);
  EXPECT_THROW(done.add(step({7})), std::logic_error);
  EXPECT_THROW(done.add(step({1, 0})), std::logic_error);
  EXPECT_THROW(done.add(step({0, 1, 2, 3})), std::logic_error);
  done.add(step({0, 1}));
  EXPECT_THROW(done.add(step({1, 2})), std::logic_error);
  EXPECT_THROW(Disassembly(2, {{{0, Pose{}}, {0, Pose{}}}}), std::invalid_argument);
  EXPECT_THROW(Disassembly(2, {{{2, Pose{}}}}), std::invalid_argument);
}

/// What is asked for is done when every group is one part or is kept together, or when the target is out.
TEST(Disassembly, IsFulfilledWhenWhatIsAskedForIsDone) {
  Rng rng(5);
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t parts = 3 + rng.below(5);
    Constraints constraints;
    for (std::uint64_t k = rng.below(3); k > 0; --k)
      constraints.together.push_back({static_cast<PartId>(rng.below(parts)), static_cast<PartId>(rng.below(parts))});
    if (rng.below(3) == 0) constraints.target = static_cast<PartId>(rng.below(parts));
    const std::vector<PartId> set = kept_sets(parts, constraints);
    Disassembly done(parts);
    for (int k = 0; k < 6 && has_open_group(done); ++k) {
      done.add(any_step(done, rng));
      bool all = true, target_out = false;
      for (const auto& group : done.groups()) {
        const bool whole = std::all_of(group.begin(), group.end(), [&](PartId id) { return set[id] == set[group[0]]; });
        EXPECT_EQ(group.empty() || kept_together(group, constraints), whole || group.empty());
        all = all && (group.empty() || whole);
        target_out = target_out || (whole && constraints.target && contains(group, *constraints.target));
      }
      EXPECT_EQ(fulfilled(done, constraints), all || target_out);
    }
  }
}

}  // namespace
}  // namespace dismantle
