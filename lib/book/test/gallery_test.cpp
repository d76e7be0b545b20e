// Pictures of kinds and of tools.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "dismantle/book/book.h"
#include "illustrator.h"
#include "instructions.h"
#include "row_plan.h"

namespace dismantle {
namespace {

TEST(Gallery, EveryDifferentPartIsThereOnceWithTheLinesThatCorrectIt) {
  Assembly a = row_of(7);  // shapes 0, 1, 2, 0, 1, 2, 0
  for (Part& part : a.parts) part.kind = PartKind{"plate", "", 0.5, "flat <and> \"wide\""};
  a.parts[1].name = "cube_a", a.parts[4].name = "cube_b";
  for (const int i : {1, 4}) a.parts[i].kind = PartKind{"screw", "M3x10", 0.9, "by its name"};
  a.parts[6].kind->stated = true;
  unsigned drawn = 0;
  const std::string html = kinds_html(a, {"screw", "plate"}, Eigen::Vector3d::UnitZ(), [&] { ++drawn; });
  EXPECT_EQ(drawn, 4u);  // screws; plates of two shapes, one of which is also stated
  EXPECT_LT(html.find("<h2>screw</h2>"), html.find("<h2>plate</h2>"));
  EXPECT_NE(html.find("2 ×"), std::string::npos);
  EXPECT_NE(html.find("90 % sure"), std::string::npos);
  EXPECT_NE(html.find("&lt;and&gt;"), std::string::npos);
  // One line for names with the same begin that no other part has; else a line for each.
  EXPECT_NE(html.find("  &quot;cube_*&quot;: {kind: screw, size: &quot;M3&quot;, length: 10}\n"), std::string::npos)
      << html;
  EXPECT_NE(html.find("  &quot;p2&quot;: {kind: plate}\n  &quot;p5&quot;: {kind: plate}\n"), std::string::npos);
  EXPECT_NE(html.find("<p class=\"sure\">stated</p>"), std::string::npos);
}

TEST(Book, TheToolOfAStepIsDrawnInItsPlace) {
  std::mt19937 random(3);
  const Assembly assembly = row_of(2);
  Plan plan = random_plan(assembly, random);
  const auto pictures = [&] {
    const auto chapters = instructions(plan, assembly, false);
    return Illustrator(assembly, Eigen::Vector3d::UnitZ())
        .step(chapters.front().steps.front(), false)
        .placed.image.pixels;
  };
  const auto without = pictures();
  const std::size_t first = plan.disassembly.size() - 1;
  plan.disassembly[first].checks.push_back({.type = "tool_access"});
  plan.disassembly[first].checks.back().notes.push_back(
      {"tool_access.tool", "",
       R"({"part": "p0", "tool": "key", "name": "key", "use": "", "at": [5, 6, 7], "from": [0, 0, 1],
       "handle": [1, 0, 0], "swing": 1, "picture": {"origin": [5, 6, 7], "mm": 1000, "travel": 3,
       "tool": [{"tube": {"radius": 20, "inner": 0, "z": [0, 300]}}]}})"});
  EXPECT_NE(pictures(), without);
  plan.disassembly[first].checks.back().notes.front().kind = "other.tool";
  EXPECT_EQ(pictures(), without);
}

}  // namespace
}  // namespace dismantle
