// precedence.dot is Graphviz whatever the parts are called: checked with a tokenizer that follows the language's rules.
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "dismantle/plan_io/animation.h"

namespace dismantle {
namespace {

using Names = std::set<std::string>;
using Edges = std::set<std::pair<std::string, std::string>>;

/// Reads the statements of the graph; a name comes back as Graphviz keeps it (backslashes doubled).
void read(const std::string& dot, Names& nodes, Edges& edges) {
  const std::size_t begin = dot.find("{\n");
  ASSERT_NE(begin, std::string::npos);
  ASSERT_NE(dot.find("digraph precedence {\n"), std::string::npos);
  ASSERT_EQ(dot.substr(dot.size() - 2), "}\n");
  std::size_t at = begin + 2;
  const auto string = [&] {
    std::string out;
    EXPECT_EQ(dot[at], '"');
    for (++at; at < dot.size() && dot[at] != '"'; ++at) {
      if (dot[at] == '\\' && dot[at + 1] == '"')
        ++at;
      else if (dot[at] == '\\' && dot[at + 1] == '\\')
        out += dot[at++];
      EXPECT_NE(dot[at], '\n');
      out += dot[at];
    }
    ++at;
    return out;
  };
  while (dot[at] != '}') {
    while (dot[at] == ' ') ++at;
    if (dot[at] != '"') {  // settings of the graph
      at = dot.find('\n', at) + 1;
      continue;
    }
    const std::string a = string();
    if (dot.compare(at, 4, " -> ") == 0) {
      at += 4;
      const std::string b = string();
      ASSERT_EQ(dot.compare(at, 2, ";\n"), 0);
      at += 2;
      EXPECT_TRUE(edges.emplace(a, b).second);
    } else {
      ASSERT_EQ(dot.compare(at, 8, " [label="), 0) << dot.substr(at);
      at += 8;
      string();
      at = dot.find('\n', at) + 1;
      EXPECT_EQ(dot.compare(at - 3, 3, "];\n"), 0);
      EXPECT_TRUE(nodes.insert(a).second);
    }
  }
}

TEST(Dot, HoldsEveryPartAndEveryEdgeWhateverTheNames) {
  const std::vector<std::string> names = {"plain",       "with space", "quo\"te", "back\\slash", "end\\", "größe ✓",
                                          "line\nbreak", "a->b;",      "]"};
  Plan plan;
  for (unsigned i = 0; i < names.size(); ++i) plan.assembly.parts.push_back({i, names[i], ""});
  PlanStep s;
  s.step = 1;
  s.moves = {{"end\\", {}}, {"plain", {}}};
  s.separates = {{"end\\"}};
  plan.disassembly = {s};
  std::vector<std::pair<std::string, std::string>> precedence;
  for (std::size_t i = 1; i < names.size(); ++i) precedence.emplace_back(names[i - 1], names[i]);
  Names nodes;
  Edges edges;
  const std::string dot = to_dot(plan, precedence);
  read(dot, nodes, edges);
  EXPECT_EQ(nodes.size(), names.size());
  EXPECT_EQ(edges.size(), precedence.size());
  EXPECT_TRUE(nodes.contains("quo\"te"));
  EXPECT_TRUE(nodes.contains("end\\\\"));
  EXPECT_TRUE(nodes.contains("line break"));
  EXPECT_NE(dot.find("label=\"1. end\\\\\"]"), std::string::npos) << "the step is in the label";
  EXPECT_EQ(dot.find("1. plain"), std::string::npos) << "that one moved, and is not out";
}

TEST(Dot, BytesThatAreNotUtf8AreReplaced) {
  Plan plan;
  plan.assembly.parts.push_back({0,
                                 "gr\xf6\xdf"
                                 "e",
                                 ""});
  EXPECT_NE(to_dot(plan, {}).find("gr\xEF\xBF\xBD"), std::string::npos);
}

TEST(Dot, EmptyPlanIsAnEmptyGraph) {
  Names nodes;
  Edges edges;
  read(to_dot(Plan{}, {}), nodes, edges);
  EXPECT_TRUE(nodes.empty() && edges.empty());
}

}  // namespace
}  // namespace dismantle
