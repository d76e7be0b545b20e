// Parameters that hold plugins: binding, overrides of single items, presets, and the objects made from them.
#include <gtest/gtest.h>

#include "dismantle/host/config.h"
#include "dismantle/path_planner.h"
#include "scratch.h"

namespace dismantle {
namespace {

class Nested : public testing_support::Scratch {
 protected:
  static const std::vector<PluginChoice>& of(const PluginChoice& team) {
    return std::get<std::vector<PluginChoice>>(team.parameters.at("of"));
  }
  static double number(const PluginChoice& choice, const char* name) {
    return std::get<double>(choice.parameters.at(name));
  }
  static std::int64_t after(const PluginChoice& choice) { return std::get<std::int64_t>(choice.options.at("after")); }
};

TEST_F(Nested, BindsListsAndSinglePlugins) {
  const RunConfig config = load_text(R"(schema: 1
path_planner:
  type: team
  of:
    - {type: t_rrt, goal_bias: 0.2, after: 5}
    - bfs
    - type: team
      of: [{type: bfs, motion: rotation}]
  last: {type: t_rrt, range: 0.25}
)");
  const auto& items = of(config.path_planner);
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].type, "t_rrt");
  EXPECT_EQ(number(items[0], "goal_bias"), 0.2);
  EXPECT_EQ(number(items[0], "range"), 0.5);  // its default
  EXPECT_EQ(after(items[0]), 5);
  EXPECT_EQ(items[1].type, "bfs");
  EXPECT_EQ(after(items[1]), 0);
  EXPECT_EQ(std::get<std::string>(of(items[2])[0].parameters.at("motion")), "rotation");
  EXPECT_EQ(number(std::get<PluginChoice>(config.path_planner.parameters.at("last")), "range"), 0.25);
  EXPECT_EQ(config.origins.at("path_planner.of.0.goal_bias"), "run.yaml:5");
  EXPECT_EQ(config.origins.at("path_planner.of.0.range"), "default");
  EXPECT_EQ(config.origins.at("path_planner.of.2.of.0.motion"), "run.yaml:8");
  EXPECT_NE(registry_.create<PathPlanner>(config.path_planner.type, config.path_planner.parameters), nullptr);
}

TEST_F(Nested, AllErrorsHaveTheirPlaces) {
  EXPECT_EQ(errors_of(R"(schema: 1
path_planner:
  type: team
  fiar: true
  of:
    - {type: t_rrt, goal_bais: 0.2, after: -1}
    - {type: bsf}
    - {type: progressive}
    - {motion: rotation}
    - [bfs]
    - {type: clash}
    - {type: team}
    - {type: team, of: []}
    - {type: bfs, goal_bias: 0.1}
  last: {type: 3}
)"),
            R"(run.yaml:4:3: error: unknown key 'fiar' in path_planner (team); did you mean 'fair'?
run.yaml:6:21: error: unknown key 'goal_bais' in path_planner.of.0 (t_rrt); did you mean 'goal_bias'?
run.yaml:6:44: error: path_planner.of.0.after must be >= 0, got -1 [t_rrt 0.1.0, libfixture.so]
run.yaml:7:14: error: unknown path_planner 'bsf'; did you mean 'bfs'?
run.yaml:8:14: error: 'progressive' is a sequence_planner, not a path_planner
run.yaml:9:7: error: path_planner.of.3 has no 'type': it must be the id of a path_planner
run.yaml:10:7: error: path_planner.of.4 must be a path_planner, as '{type: ID, ...}', got a list
run.yaml:11:7: error: path_planner.of.5: 'clash' has a parameter 'after', which here is read by what holds it, so that it cannot stand here
run.yaml:12:7: error: path_planner.of.6 (team) needs the key 'of', which has no default
run.yaml:13:24: error: path_planner.of.7.of has to name a path_planner
run.yaml:14:19: error: unknown key 'goal_bias' in path_planner.of.8 (bfs); it belongs to path_planner.of.0 (t_rrt)
run.yaml:15:16: error: unknown path_planner '3'; there are: bfs, clash, duo, guided, pairs, solo, t_rrt, team
)");
  EXPECT_EQ(errors_of("schema: 1\npath_planner: {type: team, of: bfs}\n"),
            "run.yaml:2:32: error: path_planner.of must be a list of path_planners, got a value\n");
  EXPECT_EQ(errors_of("schema: 1\npath_planner: {type: team}\n"),
            "run.yaml:2:15: error: path_planner (team) needs the key 'of', which has no default\n");
}

TEST_F(Nested, CapabilitiesOfWhatIsHeldCount) {
  EXPECT_EQ(
      errors_of("schema: 1\nsimulator: {type: geometry_only}\npath_planner: {type: team, of: [t_rrt], last: t_rrt}\n"),
      "");
  EXPECT_EQ(
      errors_of(
          "schema: 1\nsimulator: {type: geometry_only}\npath_planner: {type: team, of: [t_rrt, bfs], last: t_rrt}\n"),
      "run.yaml:3:22: error: path_planner 'bfs' needs a simulator with dynamics, which 'geometry_only' does not "
      "have\n");
}

TEST_F(Nested, DepthIsLimited) {
  std::string inner = "bfs";
  for (int k = 0; k < 15; ++k) inner = "{type: team, of: [" + inner + "]}";
  EXPECT_EQ(errors_of("schema: 1\npath_planner: " + inner + "\n"), "");
  for (int k = 0; k < 5; ++k) inner = "{type: team, of: [" + inner + "]}";
  EXPECT_NE(errors_of("schema: 1\npath_planner: " + inner + "\n").find("hold each other more than 16 deep"),
            std::string::npos);
}

// Law: a layer may change single items of the list below, by index or by type; the rest stays.
TEST_F(Nested, LayersReachIntoLists) {
  write("base.yaml",
        "schema: 1\npath_planner: {type: team, of: [{type: t_rrt, goal_bias: 0.2, after: 5}, bfs, bfs]}\n");
  write("top.yaml", "schema: 1\nextends: base.yaml\npath_planner: {of: {1: {motion: rotation}}}\n");
  const RunConfig config = load(
      "top.yaml", {"path_planner.of.t_rrt.range=0.25", "path_planner.of.2.type=guided", "path_planner.of.1.after=9"});
  const auto& items = of(config.path_planner);
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(number(items[0], "goal_bias"), 0.2);
  EXPECT_EQ(number(items[0], "range"), 0.25);
  EXPECT_EQ(after(items[0]), 5);
  EXPECT_EQ(std::get<std::string>(items[1].parameters.at("motion")), "rotation");
  EXPECT_EQ(after(items[1]), 9);
  EXPECT_EQ(items[2].type, "guided");
  EXPECT_EQ(config.origins.at("path_planner.of.0.range"), "<--set>:1");
  EXPECT_EQ(config.origins.at("path_planner.of.1.motion"), "top.yaml:3");
  EXPECT_EQ(errors({"top.yaml",
                    {"path_planner.of.3.after=1", "path_planner.of.bfs.after=1", "path_planner.of.trrt.after=1"},
                    {}}),
            "<--set>:1: error: path_planner.of has no item '3'; items are 0 (t_rrt), 1 (bfs), 2 (bfs)\n"
            "<--set>:2: error: path_planner.of has 2 items of type 'bfs': name one by its index, from 0\n"
            "<--set>:3: error: path_planner.of has no item 'trrt'; did you mean 't_rrt'?\n");
}

// Law: an item, or a plugin held alone, whose type changes starts afresh.
TEST_F(Nested, ChangedTypeDropsTheParametersOfTheOther) {
  write("base.yaml",
        "schema: 1\npath_planner: {type: team, of: [{type: bfs, motion: rotation}], last: {type: bfs, motion: "
        "rotation}}\n");
  const RunConfig same = load("base.yaml", {"path_planner.of.0.type=bfs", "path_planner.last.type=bfs"});
  EXPECT_EQ(std::get<std::string>(of(same.path_planner)[0].parameters.at("motion")), "rotation");
  const RunConfig other = load("base.yaml", {"path_planner.of.0.type=guided", "path_planner.last.type=guided"});
  EXPECT_EQ(std::get<std::string>(of(other.path_planner)[0].parameters.at("motion")), "auto");
  EXPECT_EQ(
      std::get<std::string>(std::get<PluginChoice>(other.path_planner.parameters.at("last")).parameters.at("motion")),
      "auto");
}

TEST_F(Nested, PresetsAreTypesWithOtherDefaults) {
  registry_.scan();
  EXPECT_TRUE(registry_.problems().empty());
  EXPECT_EQ(registry_.find("duo").preset_of, "team");
  EXPECT_EQ(registry_.find("solo").preset_of, "duo");
  const RunConfig plain = load_text("schema: 1\npath_planner: {type: duo}\n");
  ASSERT_EQ(of(plain.path_planner).size(), 2u);
  EXPECT_EQ(number(of(plain.path_planner)[1], "goal_bias"), 0.25);
  EXPECT_EQ(after(of(plain.path_planner)[1]), 7);
  EXPECT_EQ(plain.origins.at("path_planner.of.1.goal_bias"), "preset duo");
  EXPECT_EQ(plain.origins.at("path_planner.type"), "run.yaml:2");

  const RunConfig set =
      load_text("schema: 1\npath_planner: {type: duo}\n",
                {"path_planner.of.1.range=0.125", "path_planner.of.bfs.after=3", "path_planner.fair=false"});
  EXPECT_EQ(number(of(set.path_planner)[1], "goal_bias"), 0.25);
  EXPECT_EQ(number(of(set.path_planner)[1], "range"), 0.125);
  EXPECT_EQ(after(of(set.path_planner)[0]), 3);
  EXPECT_FALSE(std::get<bool>(set.path_planner.parameters.at("fair")));
  EXPECT_EQ(set.origins.at("path_planner.of.1.range"), "<--set>:1");
  EXPECT_EQ(set.origins.at("path_planner.of.1.goal_bias"), "preset duo");

  const RunConfig replaced = load_text("schema: 1\npath_planner: {type: duo, of: [guided]}\n");
  ASSERT_EQ(of(replaced.path_planner).size(), 1u);
  EXPECT_EQ(
      errors_of("schema: 1\npath_planner: {type: duo, motion: rotation}\n"),
      "run.yaml:2:27: error: unknown key 'motion' in path_planner (duo); it belongs to path_planner.of.0 (bfs)\n");
  EXPECT_NE(registry_.create<PathPlanner>("duo"), nullptr);
  EXPECT_NE(registry_.create<PathPlanner>("solo"), nullptr);
  EXPECT_THROW(registry_.create<PathPlanner>("team"), PluginError);  // of whom?
}

TEST_F(Nested, PresetsThatCannotBeUsed) {
  const auto preset = [&](const std::string& id, const std::string& text) {
    write("more/presets/path_planner/" + id + ".yaml", "schema: 1\nsummary: A test.\n" + text);
  };
  preset("acme.a", "path_planner: {type: team, of: [acme.b]}\n");
  preset("acme.b", "path_planner: {type: team, of: [bfs, acme.c]}\n");
  preset("acme.c", "path_planner: {type: acme.a}\n");
  preset("acme.typo", "path_planner: {type: bfs, motoin: rotation}\n");
  preset("acme.good", "path_planner: {type: bfs, motion: rotation}\n");
  preset("acme.extra", "path_planner: {type: bfs}\nrun: {seed: 1}\n");
  preset("nodot", "path_planner: {type: bfs}\n");
  registry_.add_search_path("more");
  registry_.scan();
  const auto problem = [&](const std::string& id) {
    for (const auto& p : registry_.problems())
      if (p.types == std::vector<std::string>{id}) return p.message;
    return std::string();
  };
  EXPECT_NE(problem("acme.a").find("holds itself: acme.a -> acme.b -> acme.c -> acme.a"), std::string::npos)
      << problem("acme.a");
  EXPECT_NE(problem("acme.typo").find("acme.typo.yaml:3:27: error: unknown key 'motoin'"), std::string::npos)
      << problem("acme.typo");
  EXPECT_NE(problem("acme.extra").find("acme.extra.yaml:4:1: error: unknown key 'run' in a preset"), std::string::npos)
      << problem("acme.extra");
  EXPECT_NE(problem("nodot").find("must carry a dot"), std::string::npos) << problem("nodot");
  EXPECT_EQ(problem("acme.good"), "");
  EXPECT_NE(registry_.lookup("acme.good"), nullptr);
  for (const char* id : {"acme.a", "acme.b", "acme.c", "acme.typo", "acme.extra", "nodot"})
    EXPECT_EQ(registry_.lookup(id), nullptr) << id;
  EXPECT_NE(errors_of("schema: 1\npath_planner: {type: acme.typo}\n").find("motoin"), std::string::npos);
}

TEST_F(Nested, AnUnboundReferenceMakesNothing) {
  const PluginRef<PathPlanner> unbound("bfs");
  EXPECT_EQ(unbound.type(), "bfs");
  EXPECT_THROW(unbound.create(), std::logic_error);
}

}  // namespace
}  // namespace dismantle
