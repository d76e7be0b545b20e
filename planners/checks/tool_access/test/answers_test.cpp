// Assemblies with known answers, whatever their pose and unit, and in scaled copies with scaled tools' sizes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "scene.h"

namespace dismantle::checks {
namespace {

using namespace test;
using nlohmann::json;

const json none = json::array();

// Only the short arm of a key fits between the screw and the roof; under a lower roof, nothing does.
TEST(KnownAnswers, AScrewUnderARoof) {
  for (const double high : {42.0, 14.0}) {
    Scene scene;
    const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
    const PartId roof = scene.add("roof", shapes::box({-90, -90, high}, {90, 90, high + 4}));
    everywhere(scene, [&](const Assembly& assembly, const Vector3d& down) {
      const StepVerdict v = judge(ToolAccess(), assembly, {screw_id}, {plate_id, roof}, down);
      if (high > 40) {
        EXPECT_EQ(data_of(v, "tool")["use"], "short arm in the screw");
      } else {
        EXPECT_EQ(v.cost, 1);
        EXPECT_EQ(data_of(v, "blocked")["in_the_way"], json::array({"roof"}));
        EXPECT_EQ(data_of(v, "blocked")["room_before"], json::array({"roof"}));
      }
    });
  }
}

// A nut on a stud in a box: it has to be tightened before the lid is there.
TEST(KnownAnswers, ANutThatComesBeforeALid) {
  Scene scene;
  const PartId nut = scene.add("nut", solids::nut(solids::polygon(6, 5.5), 3, 2.4), {0, 0, 0});
  const PartId stud = scene.add("stud", shapes::tube(0, 1.5, -10, 6, 48));
  const PartId box = scene.add("box", shapes::tube(150, 160, -10, 9, 96));
  const PartId lid = scene.add("lid", shapes::box({-160, -160, 9}, {160, 160, 12}));
  everywhere(scene, [&](const Assembly& assembly, const Vector3d& down) {
    EXPECT_EQ(judge(ToolAccess(), assembly, {nut}, {stud, box}, down).cost, 0);
    const StepVerdict v = judge(ToolAccess(), assembly, {nut}, {stud, box, lid}, down);
    EXPECT_EQ(v.cost, 1);
    const json data = data_of(v, "blocked");
    EXPECT_EQ(data["in_the_way"], json::array({"lid"}));
    EXPECT_EQ(data["room_before"], json::array({"lid"}));
    EXPECT_FALSE(data.contains("turn_first"));
    EXPECT_NE(v.notes[0].text.find("There is room before 'lid' is there."), std::string::npos) << v.notes[0].text;
  });
}

/// A disc about (25, 0) with a hole that is over the screw when the disc is turned by `angle`.
Mesh wheel(double angle, double low, double high) {
  constexpr int n = 144;
  const Vector3d middle(25, 0, 0);
  const double hole = 5;
  // The ring between the hole and the circumference, drawn about the middle of the hole.
  const Vector3d at = middle + 25 * Vector3d(-std::cos(angle), std::sin(angle), 0);
  Mesh mesh;
  for (int k = 0; k < n; ++k) {
    const double a = 2 * std::numbers::pi * k / n;
    const Vector3d ray(std::cos(a), std::sin(a), 0), off = at - middle;
    const double b = off.dot(ray), r = 40;
    const double far = -b + std::sqrt(b * b - off.squaredNorm() + r * r);
    for (const double z : {low, high})
      for (const double d : {hole, far}) mesh.vertices.push_back(at + d * ray + z * Vector3d::UnitZ());
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t a = 4 * k, b = 4 * ((k + 1) % n);
    const auto quad = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
      mesh.triangles.push_back({p, q, r});
      mesh.triangles.push_back({p, r, s});
    };
    quad(a + 1, b + 1, b + 3, a + 3);  // outside
    quad(a + 2, b + 2, b, a);          // the hole
    quad(a + 3, b + 3, b + 2, a + 2);  // above
    quad(a, b, b + 1, a + 1);          // below
  }
  return mesh;
}

// A screw behind a wheel that must be turned first, so that its hole is over the screw.
TEST(KnownAnswers, AScrewBehindAWheelThatMustBeTurnedFirst) {
  for (const int degrees : {70, -40, 0}) {
    Scene scene;
    const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
    const PartId wheel_id = scene.add("wheel", wheel(degrees * std::numbers::pi / 180, 6, 14));
    everywhere(scene, [&](const Assembly& assembly, const Vector3d& down) {
      const StepVerdict v = judge(ToolAccess(), assembly, {screw_id}, {plate_id, wheel_id}, down);
      EXPECT_EQ(v.cost, degrees == 0 ? 0 : 1);
      if (degrees == 0) return;
      const json data = data_of(v, "blocked");
      EXPECT_EQ(data["in_the_way"], json::array({"wheel"}));
      ASSERT_TRUE(data.contains("turn_first")) << v.notes[0].text;
      EXPECT_EQ(data["turn_first"]["part"], "wheel");
      // The direction of the axis is that of the shape; the smallest turn may be less, as the hole has play.
      EXPECT_NEAR(std::abs(int(data["turn_first"]["degrees"])), std::abs(degrees), 10);
      EXPECT_NE(v.notes[0].text.find("degrees first"), std::string::npos);
    });
  }
}

// Four screws on a square; a cover hides one of them.
TEST(KnownAnswers, APatternWithAScrewUnderACover) {
  Scene scene;
  const FourScrews pattern(scene);
  const PartId cover = scene.add("cover", shapes::box({-12, -12, 6}, {12, 12, 9}));
  everywhere(scene, [&](const Assembly& assembly, const Vector3d& down) {
    for (std::size_t i = 0; i < pattern.screws.size(); ++i) {
      const StepVerdict v =
          judge(ToolAccess(), assembly, {pattern.screws[i]}, {pattern.lid, pattern.base, cover}, down);
      EXPECT_EQ(v.cost, i == 0 ? 1 : 0) << i;
      const json data = json::parse(v.notes.at(0).data);
      EXPECT_EQ(data.value("in_the_way", none), i == 0 ? json::array({"cover"}) : none);
      EXPECT_EQ(v.notes.back().kind, "tool_access.pattern");
      EXPECT_NE(v.notes.back().text.find("'s1', 's3', 's2' and 's4'"), std::string::npos) << v.notes.back().text;
    }
    EXPECT_EQ(judge(ToolAccess(), assembly, {pattern.screws[0]}, {pattern.lid, pattern.base}, down).cost, 0);
  });
}

// A tool that the user has, but does not name, is named where it helps.
TEST(KnownAnswers, AnotherToolOfTheCatalogueReaches) {
  Scene scene;
  const PartId screw_id = scene.add("screw", screw(), {0, 0, -10}), plate_id = scene.add("plate", plate());
  const PartId deep = scene.add("deep", wall(4, 80));
  everywhere(scene, [&](const Assembly& assembly, const Vector3d& down) {
    const ToolAccess one(ToolAccessParameters{.only = "hex_key_2.5"}), other(ToolAccessParameters{.only = "hex_key_3"});
    for (const ToolAccess* check : {&one, &other}) {
      const StepVerdict v = judge(*check, assembly, {screw_id}, {plate_id, deep}, down);
      EXPECT_EQ(v.cost, 1);
      EXPECT_TRUE(data_of(v, "blocked").contains("left_out")) << v.notes[0].text;
    }
    EXPECT_FALSE(
        data_of(judge(ToolAccess(), assembly, {screw_id}, {plate_id, deep}, down), "tool").contains("left_out"));
  });
}

// Law: an M3x10 that is drawn at twice its size is an M6x20, and so is its well.
TEST(KnownAnswers, AScaledCopyHasTheAnswerOfItsTrueSize) {
  Scene copy, own;
  copy.add("screw", screw(), {0, 0, -10}), copy.add("plate", plate()), copy.add("low", wall(4, 40));
  for (Mesh& mesh : copy.meshes)
    for (Vector3d& p : mesh.vertices) p *= 2;
  own.add("screw", solids::screw({6, 20, 11, 6, {}, solids::polygon(6, 5), 3}), {0, 0, -20});
  own.meshes.push_back(copy.meshes[1]), own.names.push_back("plate");
  own.meshes.push_back(copy.meshes[2]), own.names.push_back("low");
  json answer;
  everywhere(own, [&](const Assembly& assembly, const Vector3d& down) {
    answer = data_of(judge(ToolAccess(), assembly, {0}, {1, 2}, down), "tool");
    EXPECT_EQ(answer["size"], "M6x20");
  });
  everywhere(copy, [&](const Assembly& assembly, const Vector3d& down) {
    const json data = data_of(judge(ToolAccess(), assembly, {0}, {1, 2}, down), "tool");
    for (const char* key : {"size", "tool", "use", "drive"}) EXPECT_EQ(data[key], answer[key]) << key;
  });
}

}  // namespace
}  // namespace dismantle::checks
