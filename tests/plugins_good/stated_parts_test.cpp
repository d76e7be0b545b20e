// The section `parts:`: what the user states of parts.
#include <gtest/gtest.h>

#include "dismantle/host/config.h"
#include "scratch.h"

namespace dismantle {
namespace {

class StatedParts : public testing_support::Scratch {
 protected:
  static Assembly assembly() {
    Assembly out;
    for (const char* name : {"screw_1", "screw_2", "lid", "a[1]"}) {
      Part& part = out.parts.emplace_back();
      part.id = static_cast<PartId>(out.parts.size() - 1);
      part.name = name;
      part.kind = PartKind{"screw", "M4x20", 0.9, "by shape"};
    }
    return out;
  }
};

TEST_F(StatedParts, ReplaceWhatTheyStateAndNothingElse) {
  const RunConfig config = load_text(
      "schema: 1\n"
      "parts:\n"
      "  \"screw_*\": {kind: bolt, size: M3, length: 10, torque: 0.6, glue: threadlocker}\n"
      "  screw_2: {length: 12}\n"
      "  lid: {kind: plate}\n"
      "  \"a[1]\": {size: M5}\n");
  Assembly parts = assembly();
  state_kinds(config.parts, parts);
  EXPECT_EQ(parts.parts[0].kind->kind, "screw");
  EXPECT_EQ(parts.parts[0].kind->size, "M3x10");
  EXPECT_NE(parts.parts[0].kind->reason.find("0.6 N m"), std::string::npos);
  EXPECT_NE(parts.parts[0].kind->reason.find("threadlocker"), std::string::npos);
  EXPECT_EQ(parts.parts[1].kind->size, "M3x12");  // the later entry wins
  EXPECT_EQ(parts.parts[2].kind->kind, "plate");
  EXPECT_EQ(parts.parts[2].kind->size, "");  // the size was that of a screw
  EXPECT_EQ(parts.parts[3].kind->size, "M5x20");
  for (const Part& part : parts.parts) {
    EXPECT_TRUE(part.kind->stated);
    EXPECT_EQ(part.kind->confidence, 1);
  }
}

TEST_F(StatedParts, SurviveTheResolvedFile) {
  const RunConfig config =
      load_text("schema: 1\nparts: {\"s*\": {kind: nut, size: \"1/4-20\", torque: 2.5}, lid: {glue: \"a: b\"}}\n");
  const RunConfig again = load_text(resolved_yaml(config, registry_, "."));
  Assembly once = assembly(), twice = assembly();
  state_kinds(config.parts, once);
  state_kinds(again.parts, twice);
  for (std::size_t i = 0; i < once.parts.size(); ++i) EXPECT_EQ(once.parts[i].kind, twice.parts[i].kind);
  EXPECT_EQ(again.parts.size(), 2u);
}

TEST_F(StatedParts, ErrorsNameThePlaceAndWhatIsMeant) {
  EXPECT_EQ(errors_of("schema: 1\nparts: {a: {kind: scew}}\n"),
            "run.yaml:2:19: error: parts.a.kind: there is no kind 'scew'; did you mean 'screw'?\n");
  EXPECT_EQ(errors_of("schema: 1\nparts: {a: {sise: M3}}\n"),
            "run.yaml:2:13: error: unknown key 'sise' in parts.a; did you mean 'size'?\n");
  EXPECT_EQ(errors_of("schema: 1\nparts: {a: {length: 0}}\n"),
            "run.yaml:2:21: error: parts.a.length must be a number above 0\n");
  EXPECT_NE(errors_of("schema: 1\nparts: [a]\n").find("parts must be a map"), std::string::npos);
  EXPECT_NE(errors_of("schema: 1\nparts: {a: {}}\n").find("with some of"), std::string::npos);
  const RunConfig config = load_text("schema: 1\nparts: {screw_3: {kind: nut}, \"x*\": {kind: nut}}\n");
  Assembly parts = assembly();
  try {
    state_kinds(config.parts, parts);
    FAIL() << "patterns without a part must be refused";
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("2:9"), std::string::npos) << text;
    EXPECT_NE(text.find("did you mean 'screw_"), std::string::npos) << text;
    EXPECT_NE(text.find("'x*'"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace dismantle
