// Laws of parameter declarations: defaults come from the struct, checks name what is wrong, text round-trips.
#include "dismantle/parameters.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "dismantle/errors.h"
#include "dismantle/run_context.h"

namespace dismantle {
namespace {

enum class Motion { translation, rotation };

struct Sample {
  double range = 0.05;
  std::int64_t seed = 3;
  unsigned depth = 4;
  bool greedy = true;
  std::string title = "plain";
  Motion motion = Motion::rotation;

  static void describe(Schema<Sample>& s) {
    s.add("range", &Sample::range, {.unit = "m", .min = 0, .max = 1, .min_open = true, .doc = "Range."});
    s.add("seed", &Sample::seed, {.unit = "1", .min = 0, .doc = "Seed."});
    s.add("depth", &Sample::depth, {.unit = "1", .doc = "Depth."});
    s.add("greedy", &Sample::greedy, {.doc = "Greedy."});
    s.add("title", &Sample::title, {.doc = "Title."});
    s.add_choice<Motion>("motion", &Sample::motion,
                         {{"translation", Motion::translation, "R3."}, {"rotation", Motion::rotation, "SE(3)."}},
                         "Motion.");
  }
};

const ParamSpec& spec(const Schema<Sample>& schema, const std::string& name) {
  for (const auto& s : schema.specs())
    if (s.name == name) return s;
  throw std::out_of_range(name);
}

TEST(Schema, DefaultsComeFromTheStruct) {
  const Schema<Sample> schema;
  EXPECT_TRUE(problems_of_schema(schema.specs()).empty());
  const ParamSet values = complete(schema.specs(), {});
  EXPECT_EQ(values.size(), schema.specs().size());
  const Sample s = schema.bind(values);
  EXPECT_EQ(s.range, 0.05);
  EXPECT_EQ(s.seed, 3);
  EXPECT_EQ(s.depth, 4u);
  EXPECT_TRUE(s.greedy);
  EXPECT_EQ(s.title, "plain");
  EXPECT_EQ(s.motion, Motion::rotation);
}

struct Child {
  PluginRef<PathPlanner> plugin;
  double share = 0.5;
  static void describe(Schema<Child>& s) {
    s.add("share", &Child::share, {.unit = "1", .min = 0, .max = 1, .doc = "Share."});
  }
};

struct Holder {
  PluginRef<PathPlanner> one{"inner"};
  PluginRef<Simulator> needed;
  std::vector<PluginRef<PathPlanner>> some{PluginRef<PathPlanner>("a"), PluginRef<PathPlanner>("b")};
  std::vector<Child> of;
  static void describe(Schema<Holder>& s) {
    s.add("one", &Holder::one, {.doc = "One."});
    s.add("needed", &Holder::needed, {.doc = "Needed."});
    s.add("some", &Holder::some, {.doc = "Some."});
    s.add("of", &Holder::of, {.doc = "Children."});
  }
};

// Law: a reference creates a new object of the named type on each call, only through the host's maker.
TEST(Schema, BindsPlugins) {
  const Schema<Holder> schema;
  EXPECT_EQ(problems_of_schema(schema.specs()), std::vector<std::string>{});
  EXPECT_THROW(complete(schema.specs(), {}), std::invalid_argument);  // `needed` and `of` have no default
  const PluginChoice child{"c", {{"depth", std::int64_t{3}}}, {{"share", 0.25}}};
  const ParamSet given{{"needed", PluginChoice{"sim", {}, {}}},
                       {"of", std::vector<PluginChoice>{child, {"d", {}, {}}}}};
  const ParamSet values = complete(schema.specs(), given);
  EXPECT_EQ(std::get<double>(std::get<std::vector<PluginChoice>>(values.at("of"))[1].options.at("share")), 0.5);
  std::vector<std::pair<PluginKind, PluginChoice>> made;
  const Holder h = schema.bind(values, [&](PluginKind kind, const PluginChoice& choice) -> std::shared_ptr<void> {
    made.emplace_back(kind, choice);
    return nullptr;
  });
  EXPECT_TRUE(made.empty());
  EXPECT_EQ(h.one.type(), "inner");
  ASSERT_EQ(h.some.size(), 2u);
  EXPECT_EQ(h.some[1].type(), "b");
  ASSERT_EQ(h.of.size(), 2u);
  EXPECT_EQ(h.of[0].share, 0.25);
  EXPECT_EQ(h.of[1].share, 0.5);
  h.needed.create();
  h.of[0].plugin.create();
  h.of[0].plugin.create();
  ASSERT_EQ(made.size(), 3u);
  EXPECT_EQ(made[0].first, PluginKind::simulator);
  EXPECT_EQ(made[1].first, PluginKind::path_planner);
  EXPECT_EQ(made[2].second, child);
  EXPECT_EQ(to_text(child), "{type: \"c\", share: 0.25, depth: 3}");
}

TEST(Schema, RefusesBadPlugins) {
  const Schema<Holder> schema;
  const ParamSet good{{"needed", PluginChoice{"sim", {}, {}}}, {"of", std::vector<PluginChoice>{{"d", {}, {}}}}};
  EXPECT_NO_THROW(complete(schema.specs(), good));
  const std::pair<const char*, ParamValue> bad[] = {
      {"of", std::vector<PluginChoice>{}},
      {"of", std::vector<PluginChoice>{{"", {}, {}}}},
      {"of", std::vector<PluginChoice>{{"d", {}, {{"share", 2.0}}}}},
      {"of", std::vector<PluginChoice>{{"d", {}, {{"shire", 0.5}}}}},
      {"of", PluginChoice{"d", {}, {}}},
      {"one", std::string("d")},
      {"one", PluginChoice{}}};
  for (const auto& [name, value] : bad) {
    ParamSet given = good;
    given[name] = value;
    EXPECT_THROW(complete(schema.specs(), given), std::invalid_argument) << name << ": " << to_text(value);
  }
}

TEST(Schema, BindsWhatIsGiven) {
  const Schema<Sample> schema;
  const Sample s = schema.bind(complete(schema.specs(), {{"range", std::int64_t{1}},
                                                         {"depth", std::int64_t{9}},
                                                         {"greedy", false},
                                                         {"motion", std::string("translation")}}));
  EXPECT_EQ(s.range, 1.0);  // an integer is a number
  EXPECT_EQ(s.depth, 9u);
  EXPECT_FALSE(s.greedy);
  EXPECT_EQ(s.motion, Motion::translation);
}

TEST(Schema, RefusesUnknownAndBadValues) {
  const Schema<Sample> schema;
  EXPECT_THROW(complete(schema.specs(), {{"rnge", 0.1}}), std::invalid_argument);
  EXPECT_THROW(complete(schema.specs(), {{"range", 2.0}}), std::invalid_argument);
  EXPECT_THROW(complete(schema.specs(), {{"greedy", std::int64_t{1}}}), std::invalid_argument);
  EXPECT_THROW(complete(schema.specs(), {{"motion", std::string("jump")}}), std::invalid_argument);
}

struct Effort {
  int tries = 3;
};

struct Studied : Effort {
  double share = 0.5;
  double step = 0.1;
  std::string title;
  bool greedy = true;
  Motion motion = Motion::rotation;
  PluginRef<PathPlanner> inner{"bfs"};

  static void describe(Schema<Studied>& s) {
    s.add("tries", &Effort::tries, {.unit = "1", .min = 1, .doc = "Tries."});
    s.advanced("share", &Studied::share, {0, 1});
    s.advanced("step", &Studied::step, {.min = 0, .min_open = true});
    s.advanced("title", &Studied::title);
    s.advanced("greedy", &Studied::greedy);
    s.advanced("motion", &Studied::motion, {{"translation", Motion::translation}, {"rotation", Motion::rotation}});
    s.advanced("inner", &Studied::inner);
  }
};

// Law: advanced parameters are checked, completed and bound as the others; only they need neither doc nor unit.
TEST(Schema, AdvancedParametersAreCheckedAsTheOthers) {
  const Schema<Studied> schema;
  EXPECT_EQ(problems_of_schema(schema.specs()), std::vector<std::string>{});
  for (const ParamSpec& spec : schema.specs()) EXPECT_EQ(spec.advanced, spec.name != "tries") << spec.name;
  EXPECT_EQ(schema.specs()[1].range_text(), "[0, 1]");
  EXPECT_EQ(schema.specs()[2].range_text(), "> 0");
  const ParamSet given = {
      {"tries", std::int64_t{7}}, {"share", std::int64_t{1}}, {"motion", std::string("translation")}};
  const Studied s = schema.bind(complete(schema.specs(), given));
  EXPECT_EQ(s.tries, 7);
  EXPECT_EQ(s.share, 1.0);
  EXPECT_EQ(s.step, 0.1);
  EXPECT_EQ(s.motion, Motion::translation);
  EXPECT_EQ(s.inner.type(), "bfs");
  for (const auto& [name, value] : ParamSet{{"share", 1.5},
                                            {"step", 0.0},
                                            {"title", true},
                                            {"greedy", std::string("yes")},
                                            {"motion", std::string("jump")},
                                            {"shre", 0.5}})
    EXPECT_THROW(complete(schema.specs(), {{name, value}}), std::invalid_argument) << name;
}

TEST(ProblemsOfSchema, AdvancedParametersHaveADefault) {
  ParamSpec s;
  s.name = "inner";
  s.type = ParamType::plugin;
  s.required = s.advanced = true;
  EXPECT_EQ(problems_of_schema({s}), std::vector<std::string>{"advanced parameter 'inner' has no default"});
  s = {};
  s.name = "advanced";
  s.unit = "1", s.doc = "Doc.", s.fallback = 1.0;
  EXPECT_EQ(problems_of_schema({s}),
            std::vector<std::string>{"parameter name 'advanced' is reserved for the map of such parameters"});
}

TEST(ParamSpec, SaysWhatIsWrong) {
  const Schema<Sample> schema;
  EXPECT_EQ(spec(schema, "range").problem_with(0.0), "must be in (0, 1], got 0 m");
  EXPECT_EQ(spec(schema, "range").problem_with(std::string("x")), "must be a number, got 'x'");
  EXPECT_EQ(spec(schema, "seed").problem_with(std::int64_t{-1}), "must be >= 0, got -1");
  EXPECT_EQ(spec(schema, "seed").problem_with(1.5), "must be an integer, got 1.5");
  EXPECT_EQ(spec(schema, "greedy").problem_with(std::string("yes")), "must be true or false, got 'yes'");
  EXPECT_EQ(spec(schema, "motion").problem_with(std::string("jump")),
            "must be one of translation, rotation; got 'jump'");
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")})
    EXPECT_TRUE(spec(schema, "range").problem_with(bad)) << bad;
}

TEST(ParamSpec, WhatTheMemberCannotHoldIsOutOfRange) {
  const Schema<Sample> schema;
  EXPECT_TRUE(spec(schema, "depth").problem_with(std::int64_t{-1}));
  EXPECT_TRUE(spec(schema, "depth").problem_with(std::int64_t{1} << 32));
  EXPECT_FALSE(spec(schema, "depth").problem_with((std::int64_t{1} << 32) - 1));
}

// Law: a value is accepted exactly if it lies between the bounds; open bounds are excluded.
TEST(ParamSpec, RangeLaw) {
  Rng rng(7);
  for (int i = 0; i < 2000; ++i) {
    ParamSpec s;
    s.name = "x";
    const double a = std::floor(rng.uniform(-5, 5)), b = std::floor(rng.uniform(-5, 5));
    const double x = std::floor(rng.uniform(-7, 7));
    if (rng.below(4) != 0) s.min = std::min(a, b), s.min_open = rng.below(2) == 0;
    if (rng.below(4) != 0) s.max = std::max(a, b), s.max_open = rng.below(2) == 0;
    const bool low = s.min && (x < *s.min || (s.min_open && x == *s.min));
    const bool high = s.max && (x > *s.max || (s.max_open && x == *s.max));
    EXPECT_EQ(s.problem_with(x).has_value(), low || high) << s.range_text() << " " << x;
  }
}

TEST(ParamSpec, RangeText) {
  ParamSpec s;
  EXPECT_EQ(s.range_text(), "");
  s.min = 0;
  EXPECT_EQ(s.range_text(), ">= 0");
  s.min_open = true;
  EXPECT_EQ(s.range_text(), "> 0");
  s.max = 1;
  s.max_open = true;
  EXPECT_EQ(s.range_text(), "(0, 1)");
  s.min.reset();
  EXPECT_EQ(s.range_text(), "< 1");
}

// Law: text of a number reads back as the same number, whatever the locale.
TEST(ToText, RoundTrips) {
  Rng rng(11);
  for (int i = 0; i < 5000; ++i) {
    const double x = rng.normal() * std::pow(10.0, rng.uniform(-300, 300));
    const std::string text = to_text(x);
    double back = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), back);
    ASSERT_EQ(read.ptr, text.data() + text.size()) << text;
    ASSERT_EQ(back, x) << text;
  }
  EXPECT_EQ(to_text(true), "true");
  EXPECT_EQ(to_text(std::int64_t{-5}), "-5");
  EXPECT_EQ(to_text(std::string("a b")), "a b");
}

TEST(ProblemsOfSchema, NamesEachFault) {
  ParamSpec s;
  s.name = "9lives";
  s.type = ParamType::number;
  s.fallback = 2.0;
  s.min = 3;
  s.max = 1;
  const auto problems = problems_of_schema({s, s});
  std::string all;
  for (const auto& p : problems) all += p + "\n";
  for (const char* part : {"'9lives' does not match", "declared twice", "has no doc", "has no unit", "empty range",
                           "default of parameter"})
    EXPECT_NE(all.find(part), std::string::npos) << part << " not in\n" << all;
}

TEST(Errors, CarryTheirPlace) {
  const Diagnostic full{"a.yaml", 6, 48, "unknown key"};
  EXPECT_EQ(full.text(), "a.yaml:6:48: error: unknown key");
  EXPECT_EQ((Diagnostic{"<--set>", 1, 0, "bad"}.text()), "<--set>:1: error: bad");
  EXPECT_EQ((Diagnostic{"a.yaml", 0, 0, "bad"}.text()), "a.yaml: error: bad");
  EXPECT_EQ((Diagnostic{"", 0, 0, "bad"}.text()), "error: bad");
  const ConfigError error({full, {"a.yaml", 7, 1, "more"}});
  EXPECT_STREQ(error.what(), "a.yaml:6:48: error: unknown key\na.yaml:7:1: error: more");
  EXPECT_STREQ(InputError("lid", "not closed").what(), "lid: not closed");
  EXPECT_EQ(PluginError("x.so", "bad").file(), "x.so");
}

}  // namespace
}  // namespace dismantle
