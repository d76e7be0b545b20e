// Laws: the surface of a tool is closed and has the volume of its prisms, where the note puts it; notes of another form
// say nothing.
#include "dismantle/plan_io/drawn_tools.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

namespace dismantle {
namespace {

std::vector<PlanVerdict> checks_with(const std::string& data, const std::string& kind = "tool_access.tool") {
  PlanVerdict verdict{.type = "tool_access"};
  verdict.notes.push_back({kind, "", data});
  return {verdict};
}

std::string place(const std::string& part, const std::string& volume) {
  return R"("part": ")" + part + R"(", "name": "key", "from": [0, 0, 1], "handle": [0, 1, 0], "swing": 1,
    "picture": {"origin": [10, 20, 30], "mm": 25.4, "travel": 3, "tool": [)" +
         volume + "]}";
}

double volume_of(const Mesh& mesh) {
  double six = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    six += mesh.vertex(t, 0).dot(mesh.vertex(t, 1).cross(mesh.vertex(t, 2)));
  return six / 6;
}

TEST(DrawnTools, ASurfaceHasTheVolumeAndThePlaceOfItsPrism) {
  const double round = 24 / 2 * std::sin(2 * std::numbers::pi / 24);  // area of the outline of a circle of radius 1
  const std::map<std::string, double> volumes = {
      {R"({"tube": {"radius": 2, "inner": 0, "z": [1, 11]}})", 10 * 4 * round},
      {R"({"tube": {"radius": 2, "inner": 1, "z": [1, 11]}})", 10 * 3 * round},
      {R"({"box": {"x": [0, 5], "y": [-1, 1], "z": [1, 11]}})", 100},
      {R"({"obround": {"from": [0, 0], "to": [6, 0], "radius": 2, "z": [1, 11]}})", 10 * (24 + 4 * round)}};
  for (const auto& [json, expected] : volumes) {
    const auto tools = drawn_tools(checks_with("{" + place("screw", json) + "}"));
    ASSERT_EQ(tools.size(), 1u) << json;
    EXPECT_TRUE(tools[0].turns);
    const Mesh mesh = mesh_of(tools[0], tools[0].tool);
    EXPECT_NEAR(volume_of(mesh) * 25.4 * 25.4 * 25.4, expected, 1e-6 * expected) << json;
    const Aabb box = mesh.box();
    EXPECT_NEAR(box.lo.z(), 30 + 1 / 25.4, 1e-9);
    EXPECT_NEAR(box.hi.z(), 30 + 11 / 25.4, 1e-9);
    EXPECT_GE(box.hi.y() - 20, 2 / 25.4 - 1e-9);  // x of the tool is y here
  }
}

TEST(DrawnTools, BothToolsOfANoteAreThere) {
  const std::string box = R"({"box": {"x": [0, 5], "y": [-1, 1], "z": [1, 11]}})";
  const auto both = drawn_tools(
      checks_with("{" + place("nut", box) + R"(, "turned": "screw", "hold": {)" + place("nut", box) + "}}"));
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].part, "screw");
  EXPECT_TRUE(both[0].turns);
  EXPECT_EQ(both[1].part, "nut");
  EXPECT_FALSE(both[1].turns);
}

TEST(DrawnTools, NotesOfAnotherFormSayNothing) {
  const std::string box = R"({"box": {"x": [0, 5], "y": [-1, 1], "z": [1, 11]}})";
  EXPECT_TRUE(drawn_tools(checks_with("{" + place("screw", box) + "}", "tool_access.blocked")).empty());
  for (const std::string data : {"", "[]", "{}", "3", "{\"part\": \"a\"}", "{\"part\": 1, \"picture\": 2}"})
    EXPECT_TRUE(drawn_tools(checks_with(data)).empty()) << data;
  for (const std::string volume : {"3", "{}", R"({"cone": {}})", R"({"box": {"x": [0]}})"})
    EXPECT_TRUE(drawn_tools(checks_with("{" + place("screw", volume) + "}")).empty()) << volume;
}

}  // namespace
}  // namespace dismantle
