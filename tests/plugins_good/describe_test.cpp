// Descriptions hold every parameter with unit, default, range and doc, in every format.
#include "dismantle/host/describe.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scratch.h"

namespace dismantle {
namespace {

using Json = nlohmann::json;

class Describe : public testing_support::Scratch {
 protected:
  Describe() { registry_.scan(); }
  const RegisteredType& type(const std::string& id) { return registry_.find(id); }
};

TEST_F(Describe, EveryParameterInEveryFormat) {
  for (const char* id : {"t_rrt", "bfs", "sdf_penalty", "random"}) {
    const RegisteredType& t = type(id);
    const std::string text = describe_text(t, registry_), markdown = describe_markdown(t, registry_);
    const Json json = Json::parse(describe_json(t, registry_));
    ASSERT_EQ(json["parameters"].size() + json["advanced"].size(), t.type.params.size());
    std::size_t declared = 0, advanced = 0;
    for (const ParamSpec& spec : t.type.params) {
      const Json& described = spec.advanced ? json["advanced"][advanced++] : json["parameters"][declared++];
      const std::size_t place = text.find("\n  " + spec.name + " = " + to_text(spec.fallback));
      ASSERT_NE(place, std::string::npos) << text;
      EXPECT_EQ(place > text.find("\nAdvanced parameters"), spec.advanced) << text;
      const std::string row = "| `" + spec.name + "` |";
      EXPECT_EQ(markdown.find(row) != std::string::npos, !spec.advanced) << markdown;
      EXPECT_EQ(describe_advanced_markdown(registry_).find(row) != std::string::npos, spec.advanced) << row;
      EXPECT_EQ(described["name"], spec.name);
      EXPECT_EQ(described["doc"], spec.doc);
      EXPECT_EQ(described.contains("min"), spec.min.has_value());
    }
  }
}

TEST_F(Describe, TextOfAPlanner) {
  const RegisteredType& t = type("bfs");
  const std::string text = describe_text(t, registry_);
  for (const char* part : {"bfs (path_planner)", "Algorithm 1", "dynamics", "dismantle.fixture 0.1.0 (MIT), built in",
                           "similarity_translation = 0.05 assembly units   (number, >= 0)",
                           "motion = auto   (choice, translation | rotation | auto)", "rotation: Twelve actions."})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST_F(Describe, MarkdownHoldsNoPathOfThisMachine) {
  const RegisteredType& t = type("t_rrt");
  const std::string text = describe_markdown(t, registry_);
  EXPECT_EQ(text.find(GOOD_FOLDER), std::string::npos);
  EXPECT_NE(text.find("Free text \\| with a bar."), std::string::npos) << text;
  EXPECT_NE(describe_sections_markdown().find("`max_penetration`"), std::string::npos);
}

TEST_F(Describe, JsonSchema) {
  const Json schema = Json::parse(json_schema(registry_));
  EXPECT_EQ(schema["required"], Json::array({"schema"}));
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["properties"]["run"]["properties"]["seed"]["minimum"], 0.0);
  const Json& planners = schema["properties"]["path_planner"]["oneOf"];
  ASSERT_EQ(planners.size(), 8u);  // bfs, clash, guided, pairs, t_rrt, team, and the presets duo, solo
  EXPECT_EQ(planners[0]["properties"]["type"]["const"], "bfs");
  EXPECT_EQ(planners[0]["required"], Json::array({"type"}));
  EXPECT_EQ(planners[3]["properties"]["type"]["const"], "guided");
  EXPECT_FALSE(planners[3].contains("required"));  // the default
  EXPECT_EQ(planners[3]["properties"]["motion"]["enum"], Json::array({"translation", "rotation", "auto"}));
  EXPECT_EQ(planners[6]["properties"]["type"]["const"], "t_rrt");
  EXPECT_EQ(planners[6]["required"], Json::array({"type"}));
  EXPECT_EQ(planners[6]["properties"]["range"]["exclusiveMinimum"], 0.0);
  EXPECT_FALSE(planners[0]["properties"].contains("lean"));
  EXPECT_EQ(planners[0]["properties"]["advanced"]["properties"]["lean"]["maximum"], 1.0);
  EXPECT_EQ(planners[0]["properties"]["advanced"]["additionalProperties"], false);
  EXPECT_FALSE(planners[6]["properties"].contains("advanced"));
  const Json& verify = schema["properties"]["verify"]["properties"];
  EXPECT_FALSE(verify.contains("tests"));
  EXPECT_EQ(verify["advanced"]["properties"]["tests"]["type"], "integer");
}

TEST_F(Describe, JsonSchemaOfPluginsThatHoldOthers) {
  const Json schema = Json::parse(json_schema(registry_));
  const Json& team = schema["properties"]["path_planner"]["oneOf"][7];
  EXPECT_EQ(team["properties"]["type"]["const"], "team");
  EXPECT_EQ(team["required"], Json::array({"type", "of"}));
  const Json& item = team["properties"]["of"]["anyOf"][0]["items"]["anyOf"][1];
  EXPECT_EQ(item["$ref"], "#/$defs/team.of");
  const Json& held = schema["$defs"]["team.of"]["oneOf"];
  ASSERT_EQ(held.size(), 8u);
  for (const Json& alternative : held) EXPECT_TRUE(alternative["properties"].contains("after"));
  // Those of the item and those of its type are keys of one map.
  EXPECT_EQ(held[0]["properties"]["advanced"]["properties"].size(), 3u) << held[0];
  EXPECT_EQ(held[7]["properties"]["of"]["anyOf"][0]["items"]["anyOf"][1]["$ref"],
            "#/$defs/team.of");  // a team in a team
  EXPECT_FALSE(schema["$defs"]["team.last"]["oneOf"][0]["properties"].contains("after"));
}

TEST_F(Describe, APresetShowsWhatItStandsFor) {
  const std::string text = describe_text(type("duo"), registry_);
  for (const char* part : {"duo (path_planner preset)", "preset of team",
                           "    of:\n      - type: bfs\n        after: 0\n        motion: rotation\n",
                           "      - type: t_rrt\n        after: 7\n", "of = [bfs, t_rrt]   (list of path_planner)",
                           "of[].after = 0   (integer, >= 0)"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  const Json json = Json::parse(describe_json(type("duo"), registry_));
  EXPECT_EQ(json["preset"]["of"], "team");
  EXPECT_EQ(json["parameters"][0]["default"][1]["goal_bias"], 0.25);
  EXPECT_EQ(json["parameters"][0]["default"][0]["advanced"], Json({{"lean", 0.25}})) << "only what differs";
  EXPECT_NE(describe_text(type("team"), registry_).find("of = none: required"), std::string::npos);
}

}  // namespace
}  // namespace dismantle
