#include "dismantle/tools/catalogue.h"

#include <gtest/gtest.h>

#include <set>

#include "dismantle/errors.h"
#include "scene.h"

namespace dismantle::tools {
namespace {

TEST(Catalogue, TheStandardOneHasToolsForCommonFasteners) {
  const std::vector<Tool>& tools = standard_catalogue();
  EXPECT_GE(tools.size(), 30u);
  for (const Tool& tool : tools)
    for (const Use& use : tool.uses) EXPECT_FALSE(use.tool.empty()) << tool.id;
  using enum fasteners::Drive;
  const auto fitting = [&](fasteners::Drive drive, double size) {
    Fastener f;
    f.drive = drive, f.size = size;
    return std::count_if(tools.begin(), tools.end(), [&](const Tool& t) { return fits(t, f); });
  };
  for (const double key : {1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 2.381}) EXPECT_GE(fitting(hex_socket, key), 1);
  for (const double flats : {4.0, 5.5, 7.0, 8.0, 10.0, 13.0, 17.0, 19.0, 11.1125})
    EXPECT_GE(fitting(outer_hex, flats), 2);
  for (const double number : {6.0, 8.0, 10.0, 20.0, 25.0}) EXPECT_GE(fitting(torx, number), 1);
  for (const double diameter : {1.9, 3.0, 4.4, 6.9, 9.0}) EXPECT_GE(fitting(cross, diameter), 1);
  for (const double slot_width : {0.5, 0.8, 1.2, 1.6}) EXPECT_GE(fitting(slot, slot_width), 1);
  EXPECT_EQ(fitting(hex_socket, 2.25), 0);
}

// Law: all that is wrong is said, with its place.
TEST(Catalogue, SaysWhatIsWrongWithLineAndColumn) {
  const std::string yaml =
      "tools:\n"
      "  - id: a\n"
      "    name: a\n"
      "    fits: [{drive: hexagon, size: 2}]\n"
      "    uses: [{swing: 400, tool: [{tube: {radius: 2, inner: 3, z: [0, 5]}}]}]\n"
      "  - {id: a, name: b, fits: [{kind: ring, size: [3, 1]}], uses: [{tool: [{cone: {}}], turn: 3}]}\n";
  try {
    read_catalogue(yaml, "my.yaml");
    FAIL();
  } catch (const ConfigError& e) {
    std::set<std::pair<int, std::string>> lines;
    std::string all;
    for (const Diagnostic& d : e.diagnostics()) {
      EXPECT_EQ(d.file, "my.yaml");
      EXPECT_GT(d.column, 0);
      all += d.text() + "\n";
    }
    EXPECT_EQ(e.diagnostics().size(), 7u) << all;
    for (const char* said : {"my.yaml:4:20", "no such drive", "at most 360", "smaller than 'radius'", "two tools 'a'",
                             "second number must be larger", "no key 'turn'", "'cone' is no volume"})
      EXPECT_NE(all.find(said), std::string::npos) << said << "\n" << all;
  }
}

TEST(Catalogue, BrokenYamlAndMissingFilesAreErrors) {
  EXPECT_THROW(read_catalogue("tools: [", "x"), ConfigError);
  EXPECT_THROW(read_catalogue("- a", "x"), ConfigError);
  EXPECT_THROW(read_catalogue(std::filesystem::path("/no/such/file.yaml")), InputError);
}

}  // namespace
}  // namespace dismantle::tools
