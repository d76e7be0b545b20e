// The YAML tree: places of keys and values, repeated keys, limits. No text may end the process.
#include "dismantle/host/config_node.h"

#include <gtest/gtest.h>

#include "dismantle/run_context.h"

namespace dismantle {
namespace {

std::string all(const std::vector<Diagnostic>& problems) {
  std::string text;
  for (const auto& p : problems) text += p.text() + "\n";
  return text;
}

TEST(ParseYaml, MarksOfKeysAndValues) {
  std::vector<Diagnostic> problems;
  const ConfigNode root = parse_yaml("a: 1\nb: {c: [x, \"2\"], d: }\n", "f.yaml", problems);
  EXPECT_EQ(all(problems), "");
  ASSERT_TRUE(root.is_map());
  const auto* b = root.find("b");
  ASSERT_NE(b, nullptr);
  EXPECT_EQ(b->key_mark.text(), "f.yaml:2");
  EXPECT_EQ(b->key_mark.column, 1);
  const auto* c = b->value.find("c");
  ASSERT_NE(c, nullptr);
  EXPECT_EQ(c->key_mark.column, 5);
  EXPECT_EQ(c->value.mark.column, 8);
  ASSERT_EQ(c->value.items.size(), 2u);
  EXPECT_EQ(c->value.items[0].scalar, "x");
  EXPECT_FALSE(c->value.items[0].quoted);
  EXPECT_TRUE(c->value.items[1].quoted);
  EXPECT_EQ(b->value.find("d")->value.kind, ConfigNode::Kind::null);
}

TEST(ParseYaml, EmptyIsAnEmptyMap) {
  for (const char* text : {"", "# nothing\n", "---\n", "~"}) {
    std::vector<Diagnostic> problems;
    const ConfigNode root = parse_yaml(text, "f.yaml", problems);
    EXPECT_TRUE(root.is_map() && root.members.empty()) << text;
    EXPECT_EQ(all(problems), "") << text;
  }
}

TEST(ParseYaml, RepeatedKeysAreReportedAtTheirOwnPlace) {
  std::vector<Diagnostic> problems;
  const ConfigNode root = parse_yaml("a: 1\nb: 2\na: 3\n", "f.yaml", problems);
  EXPECT_EQ(all(problems), "f.yaml:3:1: error: key 'a' is repeated; it stands at line 1 already\n");
  EXPECT_EQ(root.find("a")->value.scalar, "1");
}

TEST(ParseYaml, SyntaxErrorsHaveAPlace) {
  std::vector<Diagnostic> problems;
  parse_yaml("a: 1\nb: [1, 2\nc: 3\n", "f.yaml", problems);
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems[0].file, "f.yaml");
  EXPECT_GE(problems[0].line, 2);
  EXPECT_NE(problems[0].message.find("invalid YAML"), std::string::npos);
}

TEST(ParseYaml, RefusesWhatAConfigurationDoesNotNeed) {
  const std::pair<const char*, const char*> cases[] = {
      {"a: !!int 3\n", "tags are not supported"},
      {"a: 1\n---\nb: 2\n", "second YAML document"},
      {"? [x]\n: 1\n", "a key must be text"},
      {"a: &x [*x]\n", "alias of a node that is not finished"},
  };
  for (const auto& [text, says] : cases) {
    std::vector<Diagnostic> problems;
    parse_yaml(text, "f.yaml", problems);
    EXPECT_NE(all(problems).find(says), std::string::npos) << text << all(problems);
  }
}

TEST(ParseYaml, AliasesWork) {
  std::vector<Diagnostic> problems;
  const ConfigNode root = parse_yaml("a: &x {k: 1}\nb: *x\n", "f.yaml", problems);
  EXPECT_EQ(all(problems), "");
  EXPECT_EQ(root.find("b")->value.find("k")->value.scalar, "1");
}

TEST(ParseYaml, NoBombs) {
  std::string laughs = "a0: &a0 [x,x,x,x,x,x,x,x,x,x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string n = std::to_string(i), p = "*a" + std::to_string(i - 1);
    laughs +=
        "a" + n + ": &a" + n + " [" + p + "," + p + "," + p + "," + p + "," + p + "," + p + "," + p + "," + p + "]\n";
  }
  std::vector<Diagnostic> problems;
  parse_yaml(laughs, "f.yaml", problems);
  EXPECT_NE(all(problems).find("nodes"), std::string::npos) << all(problems);
  for (const char* unit : {"[", "{a: ", "- ", "? "}) {
    std::string deep;
    for (int i = 0; i < 20000; ++i) deep += unit;
    problems.clear();
    parse_yaml(deep, "f.yaml", problems);
    EXPECT_FALSE(problems.empty()) << unit;
  }
}

// Law: any bytes give a tree or problems.
TEST(ParseYaml, RandomTextsNeverEndTheProcess) {
  const std::string seed_text =
      "schema: 1\nextends: base.yaml\nsimulator: {type: sdf, stiffness: 1.0e6}\nlist: [a, 'b', \"c\\n\"]\nblock: |\n  "
      "text\n";
  const std::string spice = ":-?[]{}&*!|>'\"%@`#,\n\t \\0a~<";
  Rng rng(5);
  for (int round = 0; round < 20000; ++round) {
    std::string text = seed_text.substr(0, 1 + rng.below(seed_text.size()));
    for (std::uint64_t n = 1 + rng.below(6); n > 0; --n) {
      const std::size_t at = rng.below(text.size() + 1);
      const char c = rng.below(4) == 0 ? static_cast<char>(rng.below(256)) : spice[rng.below(spice.size())];
      if (rng.below(3) == 0 && at < text.size())
        text.erase(at, 1 + rng.below(3));
      else
        text.insert(at, 1, c);
    }
    std::vector<Diagnostic> problems;
    EXPECT_NO_THROW(parse_yaml(text, "f.yaml", problems)) << text;
  }
}

}  // namespace
}  // namespace dismantle
