#include "gravity.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "dismantle/constraints.h"
#include "dismantle/fasteners/recognise.h"
#include "dismantle/run_context.h"
#include "dismantle/statics/step_proof.h"
#include "dismantle/testing/shapes.h"
#include "solids.h"

namespace dismantle::checks {
namespace {

using Eigen::Vector3d;

Mesh block(double x, double y, double z, double dx, double dy, double dz) {
  return shapes::box({x, y, z}, {x + dx, y + dy, z + dz});
}

/// Part `moving` is put in last, from above.
struct Scene {
  explicit Scene(const std::vector<Mesh>& meshes) : assembly(shapes::assembly_of(meshes)) {
    for (PartId p = 0; p < meshes.size(); ++p) (p + 1 < meshes.size() ? present : moving).push_back({p, Pose{}});
  }
  StepQuestion question(const Vector3d& up = Vector3d::UnitZ()) const {
    return {assembly, moving, present, -Vector3d::UnitZ(), nullptr, up};
  }
  Assembly assembly;
  std::vector<PlacedPart> present, moving;
};

TEST(Gravity, ATowerNeedsNoHands) {
  const Scene tower({block(0, 0, 0, 2, 2, 1), block(0, 0, 1, 2, 2, 1), block(0.5, 0.5, 2, 1, 1, 1)});
  const StepVerdict verdict = Gravity().judge(tower.question(), RunContext{});
  EXPECT_EQ(verdict.cost, 0);
  EXPECT_TRUE(verdict.notes.empty());
  EXPECT_EQ(Gravity().estimate(tower.question(), RunContext{}).cost, 0);
}

TEST(Gravity, WhatHangsInTheAirIsHeld) {
  const Scene scene({block(0, 0, 0, 2, 2, 1), block(0, 0, 2, 2, 2, 1)});
  const StepVerdict verdict = Gravity().judge(scene.question(), RunContext{});
  EXPECT_EQ(verdict.cost, 1);
  ASSERT_EQ(verdict.notes.size(), 1u);
  EXPECT_NE(verdict.notes[0].text.find("falls down otherwise, since nothing is under it."), std::string::npos)
      << verdict.notes[0].text;
  EXPECT_NE(verdict.notes[0].data.find("\"proved\":true"), std::string::npos) << verdict.notes[0].data;
  EXPECT_EQ(Gravity().estimate(scene.question(), RunContext{}).cost, 1);
}

// A beam on one block: it stands if its middle is above the block; otherwise it tips to the side of its middle.
TEST(Gravity, ABeamTipsAboutTheEdgeOfItsSupport) {
  Rng rng(5);
  for (int k = 0; k < 40; ++k) {
    const double shift = rng.uniform(-1.9, 1.9);
    if (std::abs(std::abs(shift) - 1) < 0.05) continue;
    const Scene scene({block(-1, -1, 0, 2, 2, 1), block(shift - 2, -1, 1, 4, 2, 1)});
    const StepVerdict verdict = Gravity().judge(scene.question(), RunContext{});
    ASSERT_EQ(verdict.cost, std::abs(shift) < 1 ? 0 : 1) << shift;
    if (std::abs(shift) < 1) continue;
    const std::string towards = shift > 0 ? "tips towards +x" : "tips towards -x";
    EXPECT_NE(verdict.notes.at(0).text.find(towards), std::string::npos) << verdict.notes[0].text;
    const std::string why = std::string("since nothing is under its half towards ") + (shift > 0 ? "+x" : "-x");
    EXPECT_NE(verdict.notes.at(0).text.find(why), std::string::npos) << verdict.notes[0].text;
  }
}

// Law: the numbers are the same to the last bit wherever the parts are moved to, so that rounding decides nothing.
TEST(Gravity, WhereItStandsSaysNothing) {
  Rng rng(9);
  Scene scene({block(-1, -1, 0, 2.1, 2.3, 1.1), block(-0.7, -0.9, 1.1, 2.7, 2, 0.3)});
  const auto judged = [&](const Scene& s) {
    StepQuestion question = s.question();
    question.direction.setZero();
    return Gravity().judge(question, RunContext{});
  };
  const StepVerdict here = judged(scene);
  for (int k = 0; k < 40; ++k) {
    Scene there = scene;
    const Vector3d t(rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-9, 9));
    for (PlacedPart& p : there.present) p.pose.t = t;
    for (PlacedPart& p : there.moving) p.pose.t = t * (1 + 1e-16 * k);
    const StepVerdict moved = judged(there);
    EXPECT_EQ(moved.cost, here.cost) << k;
    ASSERT_TRUE(moved.certificate && here.certificate) << k;
    EXPECT_EQ(moved.certificate->numbers, here.certificate->numbers) << k;
  }
}

// A foot at the largest distance from the table that counts as touching: rounding decides. The proof was made where the
// pile is assembled, and holds wherever the plan has it.
TEST(Gravity, ProofsHoldWhereverThePileIs) {
  const auto on_feet = [](double gap) {
    return Scene({block(-2, -1, 0, 1, 2, 1), block(1, -1, gap, 1, 2, 1 - gap), block(-2, -1, 1, 4, 2, 0.5)});
  };
  double stands = 0, hangs = 0.5;
  for (int k = 0; k < 60; ++k) {
    const double gap = 0.5 * (stands + hangs);
    (Gravity().judge(on_feet(gap).question(), RunContext{}).cost == 0 ? stands : hangs) = gap;
  }
  ASSERT_GT(stands, 0);
  Rng rng(11);
  for (const double gap : {stands, hangs}) {
    Scene scene = on_feet(gap);
    const statics::BuiltPiles piles(scene.assembly, statics::StatedModel({}, 0.4, {}).options(scene.assembly));
    for (int k = 0; k < 40; ++k) {
      const Vector3d t(rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-9, 9));
      for (auto* parts : {&scene.present, &scene.moving})
        for (PlacedPart& p : *parts) p.pose.t = t;
      StepQuestion question = scene.question();
      question.direction.setZero();
      const StepVerdict verdict = Gravity().judge(question, RunContext{});
      ASSERT_TRUE(verdict.certificate) << gap;
      EXPECT_EQ(statics::check_step_proof(piles, question, verdict.certificate->numbers).wrong, "") << gap << ", " << k;
    }
  }
}

// Law: the picture shows what is held as falling, and the forces on it add up to nothing.
TEST(Gravity, ThePictureHasTheFallAndTheForces) {
  Rng rng(17);
  unsigned pictures = 0;
  for (int k = 0; k < 40; ++k) {
    std::vector<Mesh> meshes{block(-2, -2, 0, 4, 4, 1)};
    for (int n = 0; n < 4; ++n) meshes.push_back(block(rng.uniform(-3, 2), rng.uniform(-3, 2), 1 + n / 2, 1.7, 1.7, 1));
    const Scene scene(meshes);
    const StepVerdict verdict = Gravity().judge(scene.question(), RunContext{});
    if (verdict.notes.empty()) continue;
    const auto data = nlohmann::json::parse(verdict.notes[0].data);
    ASSERT_TRUE(data.contains("picture")) << verdict.notes[0].data;
    ++pictures;
    std::set<std::string> falling;
    for (const auto& fall : data["picture"]["falls"]) falling.insert(fall["parts"].begin(), fall["parts"].end());
    std::map<std::string, Vector3d> sum;
    std::map<std::string, double> most;
    for (const auto& arrow : data["picture"]["arrows"]) {
      const Vector3d force(arrow["force"][0], arrow["force"][1], arrow["force"][2]);
      sum.try_emplace(arrow["part"], Vector3d::Zero()).first->second += force;
      most[arrow["part"]] = std::max(most[arrow["part"]], force.norm());
    }
    for (const auto& hold : data["hold"])
      if (hold["when"] == data["picture"]["when"]) {
        EXPECT_TRUE(falling.contains(hold["part"])) << verdict.notes[0].data;
        EXPECT_TRUE(sum.contains(hold["part"])) << verdict.notes[0].data;
      }
    for (const auto& [part, force] : sum) EXPECT_LT(force.norm(), 0.02 * most[part]) << part << verdict.notes[0].data;
  }
  EXPECT_GT(pictures, 10U);
}

// A brick that hangs over, with a stud of the brick below in it: nothing is drawn that would hold it.
TEST(Gravity, BricksOfLDrawModelsHoldEachOther) {
  Mesh below = block(-1, -1, -3, 2, 2, 4), above = block(-0.6, -1, 1.2, 4, 2, 0.8);
  shapes::append(below, block(-0.15, -0.15, 1, 0.3, 0.3, 0.2));
  for (const auto& [x, y, dx, dy] : {std::array{-0.6, -1.0, 0.3, 2.0}, {0.3, -1.0, 3.1, 2.0}})
    shapes::append(above, block(x, y, 1, dx, dy, 0.2));
  Scene scene({below, above});
  EXPECT_EQ(Gravity().judge(scene.question(), RunContext{}).cost, 1);
  for (Part& part : scene.assembly.parts) part.file = "model.mpd";
  EXPECT_EQ(Gravity().judge(scene.question(), RunContext{}).cost, 0);
  // Side by side they do not.
  Scene beside({block(-1, -1, 0, 2, 2, 1), block(1, -1, 0.5, 2, 2, 1)});
  for (Part& part : beside.assembly.parts) part.file = "model.mpd";
  EXPECT_GT(Gravity().judge(beside.question(), RunContext{}).cost, 0);
}

// A counterweight: the estimate, for which the rest does not move, sees nothing of it.
TEST(Gravity, TheWholeTipsAlthoughThePartRests) {
  const Scene scene({block(-1, -1, 0, 2, 2, 1), block(-1, -1, 1, 3.5, 2, 1), block(1.5, -1, 2, 1, 2, 3)});
  EXPECT_EQ(Gravity().estimate(scene.question(), RunContext{}).cost, 0);
  const StepVerdict verdict = Gravity().judge(scene.question(), RunContext{});
  EXPECT_EQ(verdict.cost, 1);
}

// Law: the verdict does not change with the scale, nor when the whole is turned with its orientation.
TEST(Gravity, SameVerdictWhenTurnedAndScaled) {
  Rng rng(9);
  unsigned stands = 0, falls = 0;
  for (int k = 0; k < 30; ++k) {
    const double scale = std::exp(rng.uniform(-2, 2));
    const Eigen::Quaterniond q = Eigen::Quaterniond::UnitRandom();
    std::vector<Mesh> meshes{block(-2, -2, 0, 4, 4, 1)}, other;
    for (int n = 0; n < 3; ++n) meshes.push_back(block(rng.uniform(-2, 0), rng.uniform(-2, 0), 1 + n, 2.5, 2.5, 1));
    for (const Mesh& m : meshes) {
      other.push_back(m);
      for (Vector3d& v : other.back().vertices) v = scale * (q * v);
    }
    const Scene a(meshes), b(other);
    StepQuestion turned = b.question(q * Vector3d::UnitZ());
    turned.direction = q * -Vector3d::UnitZ();
    const StepVerdict x = Gravity().judge(a.question(), RunContext{}), y = Gravity().judge(turned, RunContext{});
    EXPECT_EQ(x.cost, y.cost) << k;
    ++(x.cost == 0 ? stands : falls);
  }
  EXPECT_GT(stands, 4u);
  EXPECT_GT(falls, 4u);
}

// A bolt from below through two plates that stand on a rim: put through them, it falls out; its nut holds it.
TEST(Gravity, ABoltHoldsWithItsNutOnly) {
  namespace solids = fasteners::test;
  constexpr PartId bolt = 0, upper = 1, lower = 2, nut = 3;
  Scene scene(
      {shapes::moved(solids::screw({3, 12, 5.5, 3, {}, solids::polygon(6, 2.5), 1.5}), shapes::shift({0, 0, -12})),
       shapes::joined(shapes::tube(1.7, 15, -4, 0, 64), shapes::tube(12, 15, 0, 10, 64)),
       shapes::tube(1.7, 15, -8, -4, 64),
       shapes::moved(solids::nut(solids::polygon(6, 5.5), 2.5, 2.4), shapes::shift({0, 0, -10.4}))});
  scene.assembly.unit = "mm";
  fasteners::recognise_kinds(scene.assembly, RunContext{}, {.names = false});
  ASSERT_EQ(scene.assembly.parts[bolt].kind->kind, "screw");
  ASSERT_EQ(scene.assembly.parts[nut].kind->kind, "nut");
  const auto cost = [&](const std::vector<PartId>& parts) {
    scene.present.clear();
    for (const PartId p : parts) scene.present.push_back({p, Pose{}});
    scene.moving = {scene.present.back()};
    scene.present.pop_back();
    StepQuestion question = scene.question(-Vector3d::UnitZ());
    question.direction.setZero();
    const double estimate = Gravity().estimate(question, RunContext{}).cost;
    const double judged = Gravity().judge(question, RunContext{}).cost;
    EXPECT_EQ(estimate, judged);
    return judged;
  };
  EXPECT_EQ(cost({bolt, upper, lower}), 1);
  EXPECT_EQ(cost({bolt, upper, lower, nut}), 0);
  EXPECT_EQ(cost({bolt, upper, nut}), 1);  // a plate is missing: it is not tight

  // Bores that are drawn at the diameter of the bolt overlap it all around. They hold it no more.
  for (const PartId plate : {upper, lower}) {
    OverlapPlace place;
    place.contact = ContactClass::uniform_interference;
    place.axis = Vector3d::UnitZ();
    scene.assembly.overlaps.push_back({bolt, plate, 0.01, place, std::nullopt});
  }
  EXPECT_EQ(cost({bolt, upper, lower}), 1);
  EXPECT_EQ(cost({bolt, upper, lower, nut}), 0);
}

// A screw is drawn deep in the wall of its hole: it holds, as one body with the plate. Any other part has to be held.
TEST(Gravity, AScrewInItsThreadIsFastened) {
  for (const double depth : {0.3, 0.05}) {
    Scene scene({block(0, 0, 0, 4, 4, 4), block(4 - depth, 1, 2, 2, 1, 1)});
    scene.assembly.overlaps.push_back({0, 1, depth, std::nullopt, std::nullopt});
    EXPECT_EQ(Gravity().judge(scene.question(), RunContext{}).cost, 1) << depth;
    scene.assembly.parts[1].kind.emplace();
    scene.assembly.parts[1].kind->kind = "screw";
    EXPECT_EQ(Gravity().judge(scene.question(), RunContext{}).cost, 0) << depth;
    EXPECT_EQ(Gravity().estimate(scene.question(), RunContext{}).cost, 0) << depth;
  }
}

// Law: a block that hangs over another one by less than the play of CAD settles; by more, it has to be held.
TEST(Gravity, WhatHasPlaySettles) {
  for (const double scale : {0.01, 1.0, 50.0})
    for (const auto& [gap, cost] : std::vector<std::pair<double, double>>{{0.002, 0}, {0.02, 0}, {0.3, 1}}) {
      const Scene scene({block(0, 0, 0, 2 * scale, 2 * scale, scale),
                         block(0.5 * scale, 0.5 * scale, (1 + gap) * scale, scale, scale, scale)});
      EXPECT_EQ(Gravity().judge(scene.question(), RunContext{}).cost, cost) << scale << " " << gap;
      EXPECT_EQ(Gravity().estimate(scene.question(), RunContext{}).cost, cost) << scale << " " << gap;
    }
}

// A check is asked about other assemblies, too: what it knows of one is not said of another with the same meshes.
TEST(Gravity, OtherKindsAreAnotherAssembly) {
  Scene scene({block(0, 0, 0, 4, 4, 4), block(3.7, 1, 2, 2, 1, 1)});
  scene.assembly.overlaps.push_back({0, 1, 0.3, std::nullopt, std::nullopt});
  const Gravity gravity;
  EXPECT_EQ(gravity.judge(scene.question(), RunContext{}).cost, 1);
  scene.assembly.parts[1].kind.emplace();
  scene.assembly.parts[1].kind->kind = "screw";
  EXPECT_EQ(gravity.judge(scene.question(), RunContext{}).cost, 0);
}

TEST(Gravity, WhatIsKeptTogetherIsOneBody) {
  // Two blocks in the air, one of them over the plate by far: by themselves both fall.
  Scene scene({block(0, 0, 0, 4, 4, 1), block(0, 0, 1, 1, 1, 1), block(0, 0, 3, 1, 1, 1), block(1, 0, 5, 1, 1, 1)});
  EXPECT_EQ(Gravity().judge(scene.question(), RunContext{}).cost, 2);
  EXPECT_EQ(Gravity().estimate(scene.question(), RunContext{}).cost, 2);
  Constraints constraints;
  constraints.together = {{1, 2, 3}};
  set_units(scene.assembly, constraints);
  EXPECT_EQ(Gravity().judge(scene.question(), RunContext{}).cost, 0);
  EXPECT_EQ(Gravity().estimate(scene.question(), RunContext{}).cost, 0);
}

TEST(Gravity, TooFewHandsAreARefusal) {
  const Scene scene(
      {block(0, 0, 0, 2, 2, 1), block(5, 0, 3, 1, 1, 1), block(-5, 0, 3, 1, 1, 1), block(0, 5, 3, 1, 1, 1)});
  const StepVerdict verdict = Gravity().judge(scene.question(), RunContext{});
  EXPECT_EQ(verdict.cost, 3 + 2) << "three to hold, one more than there are hands";
  EXPECT_FALSE(verdict.allowed);
  EXPECT_NE(verdict.notes.at(0).text.find("fixture"), std::string::npos);
  const StepVerdict enough = Gravity({.hands = 3}).judge(scene.question(), RunContext{});
  EXPECT_TRUE(enough.allowed);
  EXPECT_EQ(enough.cost, 3);
}

TEST(Gravity, AFixtureHoldsWhatItIsToldTo) {
  const Scene scene({block(0, 0, 0, 2, 2, 1), block(0, 0, 2, 2, 2, 1)});
  const std::string name = scene.assembly.parts[1].name;
  EXPECT_EQ(Gravity({.fixed = "nothing, " + name}).judge(scene.question(), RunContext{}).cost, 0);
}

TEST(Gravity, DensitiesMoveTheCentre) {
  // The counterweight outside of the support is heavier than the beam or not.
  const Scene scene({block(-1, -1, 0, 2, 2, 1), block(-2, -1, 1, 4, 2, 1), block(1, -1, 2, 1, 2, 1)});
  const std::string name = scene.assembly.parts[2].name;
  EXPECT_EQ(Gravity({.density = name + "=0.5"}).judge(scene.question(), RunContext{}).cost, 0);
  EXPECT_EQ(Gravity({.density = name + " = 20"}).judge(scene.question(), RunContext{}).cost, 1);
  EXPECT_THROW(Gravity({.density = "steel"}), std::invalid_argument);
  EXPECT_THROW(Gravity({.density = "steel=-1"}), std::invalid_argument);
}

TEST(Gravity, TurningWhatIsNotHeldTogetherTakesHands) {
  const Scene scene({block(0, 0, 0, 2, 2, 1), block(0, 0, 1, 2, 2, 1), block(0, 0, 2, 2, 2, 1)});
  StepQuestion before = scene.question(-Vector3d::UnitZ()), now = scene.question();
  EXPECT_EQ(Gravity().judge(now, RunContext{}).cost, 0);
  now.previous = &before;
  EXPECT_GT(Gravity().judge(now, RunContext{}).cost, 0);
}

TEST(Gravity, ManyPartsAreJudgedOneByOneAndThePlanSaysSo) {
  const Scene scene({block(-1, -1, 0, 2, 2, 1), block(-1, -1, 1, 3.5, 2, 1), block(1.5, -1, 2, 1, 2, 3)});
  const Gravity gravity({.most_parts = 2});
  EXPECT_EQ(gravity.judge(scene.question(), RunContext{}).cost, 0);
  const std::vector<StepQuestion> plan{scene.question()};
  ASSERT_EQ(gravity.judge_plan(plan, RunContext{}).notes.size(), 1u);
  EXPECT_TRUE(Gravity().judge_plan(plan, RunContext{}).notes.empty());
}

// Law: every verdict has a proof that its checker accepts, and no number of it can be changed much.
TEST(Gravity, ProofsHoldAndDoNotSurviveMutation) {
  Rng rng(21);
  unsigned held = 0, mutations = 0;
  for (int k = 0; k < 60; ++k) {
    std::vector<Mesh> meshes{block(-2, -2, 0, 4, 4, 1)};
    for (int n = 0; n < 4; ++n) meshes.push_back(block(rng.uniform(-3, 2), rng.uniform(-3, 2), 1 + n / 2, 1.7, 1.7, 1));
    const Scene scene(meshes);
    const StepQuestion question = scene.question();
    const StepVerdict verdict = Gravity().judge(question, RunContext{});
    if (!verdict.certificate) continue;  // wedged by an overlap: not proved
    const statics::BuiltPiles piles(scene.assembly, statics::StatedModel("", 0.4, "").options(scene.assembly));
    const statics::Numbers& proof = verdict.certificate->numbers;
    const statics::StepHolds found = statics::check_step_proof(piles, question, proof);
    ASSERT_EQ(found.wrong, "") << k;
    ASSERT_TRUE(found.held.contains("after") && found.held.contains("during")) << k;
    EXPECT_GE(verdict.cost, static_cast<double>(found.held.at("after").size()));
    held += !found.held.at("after").empty();
    for (const auto& [name, numbers] : proof)
      for (int trial = 0; trial < 4 && !numbers.empty(); ++trial) {
        statics::Numbers changed = proof;
        std::vector<double>& of = changed.at(name);
        double most = 0;
        for (const double x : of) most = std::max(most, std::abs(x));
        const auto at = static_cast<std::size_t>(rng.uniform(0, static_cast<double>(of.size())));
        if (name.find("gaps") != std::string::npos || name.find("push") != std::string::npos)
          of[at] = 7;
        else
          of[at] +=
              (1 + most) * (trial % 2 == 0 ? 1 : -1) * (name.find("displacement") != std::string::npos ? 1e-3 : 50);
        const statics::StepHolds now = statics::check_step_proof(piles, question, changed);
        if (name.find("falls") == std::string::npos)
          EXPECT_NE(now.wrong, "") << name << " " << at;
        else  // another motion may be one of falling, too: of the same bodies
          EXPECT_TRUE(!now.wrong.empty() || now.held == found.held);
        ++mutations;
      }
    statics::Numbers fewer = proof;
    if (auto& bodies = fewer.at("after.held"); !bodies.empty()) {
      bodies.pop_back();
      EXPECT_NE(statics::check_step_proof(piles, question, fewer).wrong, "");
    }
  }
  EXPECT_GT(held, 10u);
  EXPECT_GT(mutations, 500u);
}

}  // namespace
}  // namespace dismantle::checks
