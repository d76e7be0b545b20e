/// Replays the truth of each sample: its steps are free of collisions, and motions that it calls blocked collide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "dismantle/geometry/hull.h"
#include "sample_checks.h"

namespace dismantle::samples {
namespace {

const Probe& named(const std::vector<Probe>& parts, const std::string& name) {
  return *std::find_if(parts.begin(), parts.end(), [&](const Probe& p) { return p.name == name; });
}

bool moves_in(const TruthStep& step, const std::string& part) {
  return std::any_of(step.motions.begin(), step.motions.end(), [&](const auto& m) { return m.part == part; });
}

/// Margin for the rounding of coordinates, mm.
constexpr double kRounding = 1e-6;

/// First pair that comes closer than `distance`, or overlaps deeper than when assembled, while the parts in `present`
/// carry out `step`; empty: none.
std::string collision(const Model& model, const std::vector<Probe>& parts, const std::set<std::string>& present,
                      const TruthStep& step, const Poses& from, double distance, double until = 1.0,
                      int instants = 40) {
  for (int k = 0; k <= instants; ++k) {
    Poses at = moved(step, from, until * k / instants);
    for (const auto& a : present)
      for (const auto& b : present) {
        if (!moves_in(step, a) || a == b || (moves_in(step, b) && b < a)) continue;
        const Probe &pa = named(parts, a), &pb = named(parts, b);
        if (const TruthContact* c = contact_of(model, a, b)) {
          if (sampled_depth(pa, at[a], pb, at[b]) > c->depth + c->depth_error + kRounding)
            return a + " deeper in " + b + " at " + std::to_string(until * k / instants);
          continue;
        }
        if (closer_than(pa, at[a], pb, at[b], distance))
          return a + " and " + b + " at " + std::to_string(until * k / instants);
      }
  }
  return {};
}

std::set<std::string> all_names(const Model& model) {
  std::set<std::string> names;
  for (const auto& p : model.parts) names.insert(p.name);
  return names;
}

int instants_for(const TruthStep& step) {
  double turn = 0;
  for (const auto& m : step.motions) turn = std::max(turn, std::abs(m.screw.angle));
  return std::min(40 + static_cast<int>(turn * 12), 400);
}

void expect_truth_holds(const Model& model, Rng& rng) {
  const auto parts = probes(model, rng, 1000, 1500);
  auto present = all_names(model);
  Poses poses;
  for (const auto& name : present) poses[name] = Pose{};
  for (std::size_t s = 0; s < model.truth.steps.size(); ++s) {
    const TruthStep& step = model.truth.steps[s];
    ASSERT_EQ(collision(model, parts, present, step, poses, 0.5 * model.clearance, 1.0, instants_for(step)), "")
        << "step " << s + 1;
    poses = moved(step, poses, 1.0);
    if (step.out.empty()) continue;
    std::vector<Eigen::Vector3d> mine, rest;
    for (const auto& name : present)
      for (const auto& v : named(parts, name).mesh->vertices)
        (name == step.out ? mine : rest).push_back(poses[name] * v);
    EXPECT_TRUE(separate(mine, rest).has_value()) << "step " << s + 1;
    present.erase(step.out);
  }
  if (!model.truth.steps.empty()) {
    EXPECT_EQ(present.size(), 1u);
  }
  if (!model.truth.base.empty()) {
    EXPECT_TRUE(present.contains(model.truth.base));
  }
}

/// The stated depths are there, and the motions that separate the pairs never get deeper.
void expect_contacts_hold(const Model& model, Rng& rng) {
  const auto parts = probes(model, rng, 1000);
  for (const TruthContact& c : model.truth.contacts) {
    SCOPED_TRACE(c.a + " and " + c.b);
    const double depth = sampled_depth(named(parts, c.a), {}, named(parts, c.b), {});
    EXPECT_LE(depth, c.depth + c.depth_error + kRounding);
    EXPECT_GE(depth, 0.5 * c.depth - c.depth_error);
    if (!c.apart) continue;
    TruthStep step;
    step.motions.push_back({c.a, *c.apart});
    Poses poses;
    for (const auto& p : model.parts) poses[p.name] = Pose{};
    EXPECT_EQ(collision(model, parts, {c.a, c.b}, step, poses, 0), "");
    const Pose end = c.apart->at(1);
    std::vector<Eigen::Vector3d> mine;
    for (const auto& v : named(parts, c.a).mesh->vertices) mine.push_back(end * v);
    EXPECT_TRUE(separate(mine, named(parts, c.b).mesh->vertices).has_value());
  }
}

class EveryTruth : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryTruth, HoldsForDefaults) {
  Rng rng(21);
  expect_truth_holds(make_model(GetParam()), rng);
}

TEST_P(EveryTruth, HoldsForRandomParameters) {
  Rng rng(22);
  for (int i = 0; i < 4; ++i) {
    ParamSet drawn;
    const Model model = random_model(*find(GetParam()), rng, drawn);
    SCOPED_TRACE(text(drawn));
    expect_truth_holds(model, rng);
    if (HasFatalFailure()) return;
  }
}

TEST_P(EveryTruth, ContactsHold) {
  Rng rng(24);
  expect_contacts_hold(make_model(GetParam()), rng);
  if (find(GetParam())->clean) return;
  for (int i = 0; i < 4; ++i) {
    ParamSet drawn;
    const Model model = random_model(*find(GetParam()), rng, drawn);
    SCOPED_TRACE(text(drawn));
    expect_contacts_hold(model, rng);
    if (HasFailure()) return;
  }
}

TEST_P(EveryTruth, PrecedenceIsNecessaryAndKept) {
  const Model model = make_model(GetParam());
  Rng rng(23);
  const auto parts = probes(model, rng, 500, 2000);
  std::vector<std::string> order;
  for (const auto& step : model.truth.steps)
    if (!step.out.empty()) order.push_back(step.out);
  for (const auto& [before, after] : model.truth.precedence) {
    EXPECT_LT(std::find(order.begin(), order.end(), before), std::find(order.begin(), order.end(), after));
    // While `before` is present, the path by which `after` leaves is blocked.
    for (const auto& step : model.truth.steps) {
      if (step.out != after) continue;
      Poses poses;
      for (const auto& p : model.parts) poses[p.name] = Pose{};
      EXPECT_NE(collision(model, parts, {before, after}, step, poses, 1e-6), "") << before << " " << after;
    }
  }
}

TEST_P(EveryTruth, MatchesWhatTheSampleSays) {
  const Sample& sample = *find(GetParam());
  const Model model = make_model(GetParam());
  EXPECT_EQ(sample.solvable, !model.truth.steps.empty());
  bool turns = false, together = false;
  for (const auto& step : model.truth.steps) {
    together |= step.motions.size() > 1;
    for (const auto& motion : step.motions) turns |= motion.screw.angle != 0;
  }
  EXPECT_EQ(sample.translation_only, !turns);
  EXPECT_EQ(sample.one_at_a_time, !together);
}

INSTANTIATE_TEST_SUITE_P(All, EveryTruth, ::testing::ValuesIn(sample_names()),
                         [](const auto& test) { return test.param; });

/// Six axes and some random directions.
std::vector<Eigen::Vector3d> directions() {
  std::vector<Eigen::Vector3d> all;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) all.push_back(sign * Eigen::Vector3d::Unit(axis));
  Rng rng(31);
  for (int i = 0; i < 40; ++i) all.push_back(Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized());
  return all;
}

TruthStep rigid(const std::vector<std::string>& parts, const Screw& screw) {
  TruthStep step;
  for (const auto& part : parts) step.motions.push_back({part, screw});
  return step;
}

/// Expects a collision when the screw moves the parts together.
void expect_blocked(const Model& model, const std::vector<Probe>& parts, const std::vector<std::string>& group,
                    const Screw& screw) {
  Poses poses;
  for (const auto& p : model.parts) poses[p.name] = Pose{};
  const TruthStep step = rigid(group, screw);
  EXPECT_NE(collision(model, parts, all_names(model), step, poses, 1e-6, 1.0, 16), "")
      << group.front() << " slides " << screw.advance << " along " << screw.axis.transpose() << ", turns "
      << screw.angle;
}

TEST(Blocked, StraightPullsDoNotFreeWhatMustTurn) {
  struct Case {
    std::string sample, part;
    double travel;
  };
  for (const Case& c : {Case{"bolt_and_nut", "nut", 2.0}, Case{"ring_on_curved_tube", "ring", 20.0},
                        Case{"threaded_legs", "leg_1", 4.0}}) {
    const Model model = make_model(c.sample);
    Rng rng(32);
    const auto parts = probes(model, rng, 1000, 2000);
    for (const auto& d : directions())
      expect_blocked(model, parts, {c.part}, {d, Eigen::Vector3d::Zero(), 0, c.travel});
  }
}

TEST(Blocked, NutTurnedInPlaceOrTheWrongWay) {
  const Model model = make_model("bolt_and_nut");
  Rng rng(33);
  const auto parts = probes(model, rng, 1000, 3000);
  const double turn = 2 * std::numbers::pi;
  expect_blocked(model, parts, {"nut"}, {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), turn, 0});
  expect_blocked(model, parts, {"nut"}, {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), -turn, 1.5});
}

TEST(Blocked, SlotsNeedTheirFirstMove) {
  for (const std::string name : {"l_slot", "zigzag"}) {
    const Model model = make_model(name);
    Rng rng(34);
    const auto parts = probes(model, rng);
    const std::string part = model.truth.steps.front().motions.front().part;
    for (const auto& d : directions()) expect_blocked(model, parts, {part}, {d, Eigen::Vector3d::Zero(), 0, 60});
  }
}

/// Parts that bend in reality: as a rigid body, no straight motion avoids a deeper overlap.
TEST(Blocked, ClipsAndSealsDoNotLeaveAsRigidBodies) {
  for (const auto& [name, part, other] :
       {std::tuple{"snap_fit", "clip", "plate"}, std::tuple{"o_ring", "ring", "shaft"}}) {
    const Model model = make_model(name);
    EXPECT_FALSE(contact_of(model, part, other)->apart);
    Rng rng(36);
    const auto parts = probes(model, rng, 1000, 3000);
    Poses poses;
    for (const auto& p : model.parts) poses[p.name] = Pose{};
    for (const auto& d : directions()) {
      const TruthStep step = rigid({part}, {d, Eigen::Vector3d::Zero(), 0, 30});
      EXPECT_NE(collision(model, parts, {part, other}, step, poses, 0, 1.0, 60), "") << name << " " << d.transpose();
    }
  }
}

TEST(Blocked, InterlockNeedsTwoMotionsAtOnce) {
  const Model model = make_model("interlock3");
  Rng rng(35);
  const auto parts = probes(model, rng, 1000, 3000);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero(), up = Eigen::Vector3d::UnitZ();
  const std::vector<std::vector<std::string>> groups = {{"spindle"}, {"block"}, {"frame"}};
  for (const auto& group : groups) {
    for (const auto& d : directions()) {
      expect_blocked(model, parts, group, {d, zero, 0, 6});
    }
    for (const double turn : {-0.7, 0.7})
      for (const double rise : {-6.0, 0.0, 6.0}) expect_blocked(model, parts, group, {up, zero, turn, rise});
  }
}

}  // namespace
}  // namespace dismantle::samples
