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
    const std::string text = describe_text(t.type, *t.file), markdown = describe_markdown(t.type, *t.file);
    const Json json = Json::parse(describe_json(t.type, *t.file));
    ASSERT_EQ(json["parameters"].size(), t.type.params.size());
    for (std::size_t i = 0; i < t.type.params.size(); ++i) {
      const ParamSpec& spec = t.type.params[i];
      EXPECT_NE(text.find("  " + spec.name + " = " + to_text(spec.fallback)), std::string::npos) << text;
      EXPECT_NE(markdown.find("| `" + spec.name + "` |"), std::string::npos) << markdown;
      EXPECT_EQ(json["parameters"][i]["name"], spec.name);
      EXPECT_EQ(json["parameters"][i]["doc"], spec.doc);
      EXPECT_EQ(json["parameters"][i].contains("min"), spec.min.has_value());
    }
  }
}

TEST_F(Describe, TextOfAPlanner) {
  const RegisteredType& t = type("bfs");
  const std::string text = describe_text(t.type, *t.file);
  for (const char* part : {"bfs (path_planner)", "Algorithm 1", "dynamics", "dismantle.fixture 0.1.0 (MIT), built in",
                           "similarity_translation = 0.05 assembly units   (number, >= 0)",
                           "motion = auto   (choice, translation | rotation | auto)", "rotation: Twelve actions."})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST_F(Describe, MarkdownHoldsNoPathOfThisMachine) {
  const RegisteredType& t = type("t_rrt");
  const std::string text = describe_markdown(t.type, *t.file);
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
  ASSERT_EQ(planners.size(), 4u);
  EXPECT_EQ(planners[0]["properties"]["type"]["const"], "bfs");
  EXPECT_EQ(planners[0]["required"], Json::array({"type"}));
  EXPECT_EQ(planners[1]["properties"]["type"]["const"], "guided");
  EXPECT_FALSE(planners[1].contains("required"));  // the default
  EXPECT_EQ(planners[1]["properties"]["motion"]["enum"], Json::array({"translation", "rotation", "auto"}));
  EXPECT_EQ(planners[3]["properties"]["type"]["const"], "t_rrt");
  EXPECT_EQ(planners[3]["required"], Json::array({"type"}));
  EXPECT_EQ(planners[3]["properties"]["range"]["exclusiveMinimum"], 0.0);
}

}  // namespace
}  // namespace dismantle
