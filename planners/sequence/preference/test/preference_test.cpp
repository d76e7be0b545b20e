#include "preference/preference.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "dismantle/testing/fake_planning.h"

namespace dismantle {
namespace {

using Eigen::Vector3d;

/// Costs what a function says of the part and of the part before it (-1: none), and does not allow some parts.
class Scripted final : public StepCheck {
 public:
  std::map<std::pair<int, int>, double> costs;  ///< by (part before, part)
  std::vector<PartId> not_allowed;
  bool remembers = true;

  StepCheckTraits traits() const noexcept override { return {.remembers_shape = remembers}; }
  StepVerdict judge(const StepQuestion& question, const RunContext&) const override {
    ++asked;
    const int before = question.previous == nullptr ? -1 : static_cast<int>(question.previous->moving.front().part);
    const PartId part = question.moving.front().part;
    StepVerdict verdict;
    if (const auto cost = costs.find({before, static_cast<int>(part)}); cost != costs.end())
      verdict.cost = cost->second;
    verdict.allowed = std::find(not_allowed.begin(), not_allowed.end(), part) == not_allowed.end();
    direction = question.direction;
    return verdict;
  }
  mutable unsigned asked = 0;
  mutable Vector3d direction;
};

struct Rig {
  Assembly assembly = fake::row(5);
  Constraints constraints;
  std::shared_ptr<Scripted> check = std::make_shared<Scripted>();
  Objective objective{{{"scripted", check, 2, true}}};
  SequenceQuery query{assembly, whole_assembly(assembly), constraints, objective};

  CandidateRemoval candidate(PartId part, const Vector3d& direction = Vector3d::UnitZ()) const {
    CandidateRemoval out;
    for (const PlacedPart& p : query.start.front()) (p.part == part ? out.moving : out.rest).push_back(p);
    out.direction = direction;
    return out;
  }
  std::vector<std::size_t> sorted(const Preference& preference, const std::vector<PartId>& parts) const {
    std::vector<CandidateRemoval> all;
    for (const PartId id : parts) all.push_back(candidate(id));
    return preference.sorted(all, {});
  }
};

using Order = std::vector<std::size_t>;

TEST(Preference, SortsByCostAndKeepsTheOrderOfEqualOnes) {
  Rig rig;
  rig.check->costs = {{{-1, 1}, 3}, {{-1, 3}, 1}};
  const Preference preference(rig.query);
  EXPECT_EQ(rig.sorted(preference, {0, 1, 2, 3, 4}), (Order{0, 2, 4, 3, 1}));
  EXPECT_EQ(preference.cost(rig.candidate(3), {}), 2) << "with its weight";
}

TEST(Preference, WhatIsNotAllowedComesLast) {
  Rig rig;
  rig.check->costs = {{{-1, 1}, 3}, {{-1, 3}, 1}};
  rig.check->not_allowed = {0, 3};
  EXPECT_EQ(rig.sorted(Preference(rig.query), {0, 1, 2, 3}), (Order{2, 1, 0, 3}));
}

// Law: the candidate is the operation before the last removal.
TEST(Preference, CountsWhatTheCandidateChangesAtTheLastRemoval) {
  Rig rig;
  rig.check->costs = {{{-1, 4}, 5}, {{0, 4}, 7}, {{1, 4}, 6}, {{2, 4}, 0.5}, {{-1, 2}, 1}};
  Preference preference(rig.query);
  preference.removed(rig.candidate(4), fake::straight({rig.candidate(4).moving, {}}, Vector3d::UnitX()), {});
  EXPECT_EQ(preference.cost(rig.candidate(0), {}), 2 * (7 - 5));
  EXPECT_EQ(preference.cost(rig.candidate(1), {}), 2 * (6 - 5));
  EXPECT_EQ(preference.cost(rig.candidate(2), {}), 2 * (1 + 0.5 - 5));
  EXPECT_EQ(preference.cost(rig.candidate(3), {}), 2 * (0 - 5));
  EXPECT_EQ(rig.sorted(preference, {0, 1, 2, 3}), (Order{3, 2, 1, 0}));
  EXPECT_EQ(rig.check->direction, -Vector3d::UnitX()) << "of the insertion of the last removal";
}

TEST(Preference, ChecksThatRememberNothingAreAskedOnce) {
  Rig rig;
  rig.check->remembers = false;
  Preference preference(rig.query);
  preference.removed(rig.candidate(4), fake::straight({rig.candidate(4).moving, {}}, Vector3d::UnitX()), {});
  rig.check->asked = 0;
  rig.sorted(preference, {0, 1, 2});
  EXPECT_EQ(rig.check->asked, 3u);
}

TEST(Preference, AfterACheckHasFailedTheOrderIsThePlannersOwn) {
  struct Broken final : StepCheck {
    StepCheckTraits traits() const noexcept override { return {}; }
    StepVerdict judge(const StepQuestion&, const RunContext&) const override { throw std::runtime_error("broken"); }
  };
  Rig rig;
  rig.check->costs = {{{-1, 0}, 3}};
  rig.objective.items.push_back({"broken", std::make_shared<Broken>()});
  const Preference preference(rig.query);
  std::vector<std::string> logged;
  RunContext context;
  context.on_log = [&](LogLevel level, std::string_view text) {
    EXPECT_EQ(level, LogLevel::error);
    logged.emplace_back(text);
  };
  const std::vector<CandidateRemoval> candidates{rig.candidate(0), rig.candidate(1)};
  EXPECT_TRUE(preference.active());
  EXPECT_EQ(preference.sorted(candidates, context), (Order{0, 1}));
  EXPECT_FALSE(preference.active());
  EXPECT_EQ(preference.sorted(candidates, context), (Order{0, 1}));
  ASSERT_EQ(logged.size(), 1u);
  EXPECT_NE(logged[0].find("broken"), std::string::npos);
}

TEST(Preference, WithoutAnObjectiveThereIsNone) {
  Rig rig;
  rig.objective.items.clear();
  EXPECT_FALSE(Preference(rig.query).active());
}

}  // namespace
}  // namespace dismantle
