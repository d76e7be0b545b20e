#include "constraints.h"

#include <gtest/gtest.h>

#include "dismantle/errors.h"

namespace dismantle::serve {
namespace {

const std::set<std::string> kParts{"housing", "lid", "screw: 1", "say \"x\"", "yes", "Gehäuse"};

TEST(Constraints, WhatIsWrittenIsReadBack) {
  const nlohmann::json all = {{"base", {"housing"}},
                              {"ignore", {"say \"x\"", "yes"}},
                              {"flexible", {"Gehäuse"}},
                              {"together", nlohmann::json::parse(R"([["lid", "screw: 1"], ["yes", "housing"]])")},
                              {"accept", nlohmann::json::parse(R"([{"part": "lid", "against": "screw: 1", "as": "snap",
                                                                   "depth": 1.25}])")},
                              {"target", "lid"}};
  EXPECT_EQ(constraints_in(constraints_yaml(all, kParts, "")), all);
  for (const auto& [key, value] : all.items())
    EXPECT_EQ(constraints_in(constraints_yaml({{key, value}}, kParts, "gear.yaml")), (nlohmann::json{{key, value}}));
  EXPECT_NE(constraints_yaml(all, kParts, "gear.yaml").find("extends: \"gear.yaml\""), std::string::npos);
}

TEST(Constraints, NothingToConstrainIsNoFile) {
  EXPECT_EQ(constraints_yaml(nlohmann::json::object(), kParts, "gear.yaml"), "");
  EXPECT_EQ(constraints_yaml({{"base", nlohmann::json::array()}, {"target", ""}}, kParts, ""), "");
  EXPECT_EQ(constraints_in("schema: 1\n"), nlohmann::json::object());
}

TEST(Constraints, OtherThingsAreRefused) {
  using nlohmann::json;
  for (const json& wrong :
       {json::array(), json{{"run", {{"seed", 1}}}}, json{{"base", "housing"}}, json{{"base", {1}}},
        json{{"base", {"none"}}}, json{{"together", {"lid"}}}, json{{"together", "lid"}}, json{{"target", "none"}},
        json{{"target", 1}}, json{{"accept", {"lid"}}},
        json::parse(R"({"accept": [{"part": "lid", "against": "none", "as": "snap", "depth": 1}]})"),
        json::parse(R"({"accept": [{"part": "lid", "against": "yes", "as": "snap", "depth": 0}]})"),
        json::parse(R"({"accept": [{"part": "lid", "against": "yes", "as": 1, "depth": 1}]})")})
    EXPECT_THROW(constraints_yaml(wrong, kParts, ""), Error) << wrong;
  EXPECT_THROW(constraints_in("constraints: {base: housing}"), Error);
  EXPECT_THROW(constraints_in("{"), Error);
}

}  // namespace
}  // namespace dismantle::serve
