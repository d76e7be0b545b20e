// The section `constraints`: contradictions are found wherever there are any, and unknown names come all at the same
// time with their places.
#include <gtest/gtest.h>

#include "dismantle/errors.h"
#include "dismantle/run_context.h"
#include "scratch.h"

namespace dismantle {
namespace {

using ConstraintsTest = testing_support::Scratch;

/// Is there a circle in `links`? By closure of the relation, unlike the code under test.
bool has_circle(const std::vector<std::pair<unsigned, unsigned>>& links, unsigned count) {
  std::vector<std::vector<bool>> reaches(count, std::vector<bool>(count));
  for (const auto& [a, b] : links) reaches[a][b] = true;
  for (unsigned k = 0; k < count; ++k)
    for (unsigned i = 0; i < count; ++i)
      for (unsigned j = 0; j < count; ++j) reaches[i][j] = reaches[i][j] || (reaches[i][k] && reaches[k][j]);
  for (unsigned i = 0; i < count; ++i)
    if (reaches[i][i]) return true;
  return false;
}

// Law: an order is refused exactly if a part would have to leave before itself.
TEST_F(ConstraintsTest, CirclesAreRefusedAndNothingElse) {
  Rng rng(17);
  unsigned circles = 0;
  for (int round = 0; round < 200; ++round) {
    const unsigned count = 3 + static_cast<unsigned>(rng.below(5));
    std::vector<std::pair<unsigned, unsigned>> links;
    std::string text = "schema: 1\nconstraints:\n  before:\n";
    for (auto n = 1 + rng.below(6); n > 0; --n) {
      std::vector<unsigned> chain;
      for (auto length = 2 + rng.below(2); length > 0; --length)
        chain.push_back(static_cast<unsigned>(rng.below(count)));
      text += "    - [";
      for (std::size_t k = 0; k < chain.size(); ++k) {
        text += (k == 0 ? "p" : ", p") + std::to_string(chain[k]);
        if (k > 0) links.emplace_back(chain[k - 1], chain[k]);
      }
      text += "]\n";
    }
    const bool circle = has_circle(links, count);
    circles += circle;
    const std::string errors = errors_of(text);
    EXPECT_EQ(errors.find("constraints.before contradicts itself: 'p") != std::string::npos, circle) << text << errors;
    EXPECT_EQ(errors.empty(), !circle) << text << errors;
  }
  EXPECT_GT(circles, 20u);
  EXPECT_LT(circles, 180u);
}

TEST_F(ConstraintsTest, TheCircleIsToldWithItsPlace) {
  EXPECT_EQ(errors_of("schema: 1\nconstraints:\n  before:\n    - [a, b]\n    - [b, c]\n    - [c, a]\n"),
            "run.yaml:6:8: error: constraints.before contradicts itself: 'a' before 'b' before 'c' before 'a'\n");
  // Parts that stay together leave as one.
  EXPECT_NE(errors_of("schema: 1\nconstraints: {together: [[b, c]], before: [[a, b], [c, a]]}\n").find("contradicts"),
            std::string::npos);
  EXPECT_EQ(errors_of("schema: 1\nconstraints: {together: [[b, c]], before: [[b, c], [a, b]]}\n"), "");
}

TEST_F(ConstraintsTest, OtherContradictions) {
  EXPECT_EQ(
      errors_of("schema: 1\nconstraints: {base: [a], before: [[a, b]], target: a, ignore: [c], together: [[c, b]]}\n"),
      "run.yaml:2:36: error: constraints.before wants 'a' to leave, and constraints.base wants it to stay\n"
      "run.yaml:2:52: error: constraints.target is 'a', and constraints.base wants it to stay\n"
      "run.yaml:2:80: error: constraints.together names 'c', which constraints.ignore leaves out\n");
  EXPECT_EQ(errors_of("schema: 1\nconstraints: {base: [a], before: [[b, a]]}\n"), "");  // 'a' may well stay
}

TEST_F(ConstraintsTest, OverlapsAndFlexibleParts) {
  const RunConfig config =
      load_text("schema: 1\nconstraints:\n  flexible: [spring]\n  overlap:\n    - {parts: [pin, hub], depth: 0.25}\n");
  EXPECT_EQ(config.constraints.flexible, std::vector<std::string>{"spring"});
  EXPECT_EQ(config.constraints.overlap, (std::vector<NamedOverlap>{{"pin", "hub", 0.25}}));
  EXPECT_THROW(check_constraint_names(config, {"pin", "hub"}, "gearbox"), ConfigError);
  EXPECT_NO_THROW(check_constraint_names(config, {"pin", "hub", "spring"}, "gearbox"));
  for (const char* wrong : {"3", "[3]", "[{parts: [a, b]}]", "[{parts: [a, b], depth: -1}]", "[{parts: [a], depth: 1}]",
                            "[{parts: [a, a], depth: 1}]", "[{parts: [a, b], depth: x}]",
                            "[{parts: [a, b], depth: 1, more: 2}]", "[{parts: [a, b, c], depth: 1}]"})
    EXPECT_NE(errors_of(std::string("schema: 1\nconstraints: {overlap: ") + wrong + "}\n").find("run.yaml:2:"),
              std::string::npos)
        << wrong;
}

TEST_F(ConstraintsTest, UnknownNamesComeTogetherWithTheirPlaces) {
  const RunConfig config = load_text(
      "schema: 1\nconstraints:\n  base: [housing]\n  before:\n    - [shafd, housin]\n  ignore: [zzzzzzzzzz]\n",
      {"constraints.target=shaft"});
  try {
    check_constraint_names(config, {"housing", "shaft"}, "gearbox");
    FAIL() << "accepted";
  } catch (const ConfigError& e) {
    EXPECT_STREQ(e.what(),
                 "run.yaml:5:8: error: constraints.before: gearbox has no part 'shafd'; did you mean 'shaft'?\n"
                 "run.yaml:5:15: error: constraints.before: gearbox has no part 'housin'; did you mean 'housing'?\n"
                 "run.yaml:6:12: error: constraints.ignore: gearbox has no part 'zzzzzzzzzz'; its parts: 'housing', "
                 "'shaft'");
  }
  EXPECT_NO_THROW(check_constraint_names(load_text("schema: 1\nconstraints: {base: [a]}\n"), {"a"}, "gearbox"));
}

TEST_F(ConstraintsTest, BrokenYamlIsToldOnce) {
  EXPECT_EQ(errors_of("run: [1, 2\n"), "run.yaml:2:1: error: invalid YAML: end of sequence flow not found\n");
  EXPECT_EQ(errors_of("run: {seed: 1}\n"), "run.yaml:1:1: error: missing key 'schema'; write 'schema: 1'\n");
}

TEST_F(ConstraintsTest, ToleranceHasALimit) {
  for (const char* value : {"100", "0.51", "-1", "0"})
    EXPECT_NE(errors_of(std::string("schema: 1\nverify: {max_penetration: ") + value + "}\n")
                  .find("run.yaml:2:27: error: verify.max_penetration must be"),
              std::string::npos)
        << value;
  EXPECT_EQ(errors_of("schema: 1\nverify: {max_penetration: 0.5}\n"), "");
}

}  // namespace
}  // namespace dismantle
