// Layers: `extends`, --set and options; places keep pointing at the file where something was written.
#include <gtest/gtest.h>

#include "dismantle/host/config.h"
#include "scratch.h"

namespace dismantle {
namespace {

class Layers : public testing_support::Scratch {};

TEST_F(Layers, DeepMergeAndOrigins) {
  write("base/base.yaml",
        "schema: 1\nrun: {seed: 1, timeout: 10}\npath_planner: {type: t_rrt, goal_bias: 0.1, range: 0.2}\n");
  write("base/middle.yaml", "schema: 1\nextends: base.yaml\nrun: {seed: 2}\n");
  write("top.yaml", "schema: 1\nextends: base/middle.yaml\npath_planner: {range: 0.3}\n");
  const RunConfig config = load("top.yaml");
  EXPECT_EQ(config.run.seed, 2);
  EXPECT_EQ(config.run.timeout, 10);
  EXPECT_EQ(std::get<double>(config.path_planner.parameters.at("goal_bias")), 0.1);
  EXPECT_EQ(std::get<double>(config.path_planner.parameters.at("range")), 0.3);
  EXPECT_EQ(config.origins.at("run.seed"), "base/middle.yaml:3");
  EXPECT_EQ(config.origins.at("run.timeout"), "base/base.yaml:2");
  EXPECT_EQ(config.origins.at("path_planner.range"), "top.yaml:3");
  EXPECT_EQ(config.origins.at("path_planner.type"), "base/base.yaml:3");
}

TEST_F(Layers, ErrorsPointAtTheRightFile) {
  write("base.yaml", "schema: 1\nrun: {sed: 1}\nverify: {max_penetration: 0}\n");
  write("top.yaml", "schema: 1\nextends: base.yaml\nrun: {threads: -1}\n");
  EXPECT_EQ(errors({"top.yaml", {"run.path_steps=many"}, {}}),
            "base.yaml:2:7: error: unknown key 'sed' in run; did you mean 'seed'?\n"
            "base.yaml:3:27: error: verify.max_penetration must be in (0, 0.5], got 0 assembly units\n"
            "top.yaml:3:16: error: run.threads must be in [0, 1024], got -1\n"
            "<--set>:1: error: run.path_steps must be an integer, got 'many'\n");
}

TEST_F(Layers, Cycles) {
  write("a.yaml", "schema: 1\nextends: b.yaml\n");
  write("b.yaml", "schema: 1\nextends: ./c.yaml\n");
  write("c.yaml", "schema: 1\nextends: a.yaml\n");
  write("self.yaml", "schema: 1\nextends: self.yaml\n");
  EXPECT_EQ(errors({"a.yaml", {}, {}}),
            "c.yaml:2:10: error: 'a.yaml' extends itself: a.yaml -> b.yaml -> c.yaml -> a.yaml\n");
  EXPECT_EQ(errors({"self.yaml", {}, {}}), "self.yaml:2:10: error: 'self.yaml' extends itself\n");
}

TEST_F(Layers, MissingBase) {
  EXPECT_EQ(errors_of("schema: 1\nextends: gone.yaml\nrun: {sed: 1}\n"),
            "run.yaml:2:10: error: cannot read 'gone.yaml': No such file or directory\n"
            "run.yaml:3:7: error: unknown key 'sed' in run; did you mean 'seed'?\n");
  EXPECT_EQ(errors_of("schema: 1\nextends: [a, b]\n"), "run.yaml:2:10: error: extends must be the name of a file\n");
}

// Law: a section whose type changes starts afresh; otherwise nothing is dropped.
TEST_F(Layers, ChangedTypeDropsTheParametersOfTheOther) {
  write("base.yaml", "schema: 1\npath_planner: {type: bfs, similarity_translation: 0.1}\n");
  write("top.yaml", "schema: 1\nextends: base.yaml\npath_planner: {type: t_rrt, range: 0.3}\n");
  const RunConfig config = load("top.yaml");
  EXPECT_EQ(config.path_planner.type, "t_rrt");
  EXPECT_EQ(std::get<double>(config.path_planner.parameters.at("range")), 0.3);
  write("same.yaml", "schema: 1\nextends: base.yaml\npath_planner: {type: bfs}\n");
  EXPECT_EQ(std::get<double>(load("same.yaml").path_planner.parameters.at("similarity_translation")), 0.1);
  write("implied.yaml", "schema: 1\npath_planner: {similarity_translation: 0.1}\n");  // guided by default
  EXPECT_EQ(load("implied.yaml", {}, {{"--path-planner", "path_planner.type", "t_rrt"}}).path_planner.type, "t_rrt");
  EXPECT_EQ(
      std::get<double>(
          load("implied.yaml", {"path_planner.type=guided"}).path_planner.parameters.at("similarity_translation")),
      0.1);
}

TEST_F(Layers, SetAndOptions) {
  const RunConfig config =
      load_config({std::nullopt,
                   {"path_planner.goal_bias=0.25", "assembly={subdivide: 0.125}", "path_planner.note='1'"},
                   {{"--path-planner", "path_planner.type", "t_rrt"}, {"--seed", "run.seed", "9"}}},
                  registry_);
  EXPECT_EQ(std::get<double>(config.path_planner.parameters.at("goal_bias")), 0.25);
  EXPECT_EQ(std::get<std::string>(config.path_planner.parameters.at("note")), "1");
  EXPECT_EQ(config.assembly.subdivide, 0.125);
  EXPECT_EQ(config.run.seed, 9);
  EXPECT_EQ(config.origins.at("path_planner.goal_bias"), "<--set>:1");
  EXPECT_EQ(config.origins.at("run.seed"), "<--seed>");
}

TEST_F(Layers, BadSetAndOptions) {
  EXPECT_EQ(errors({std::nullopt,
                    {"run.seed", "run..seed=1", "schema=1", "run.seed=1", "run.seed=2", "run.seed.x=2",
                     "run.timeout=[1", "ru.timeout=1", "run.threads="},
                    {{"--seed", "run.seed", "4"}, {"--path-planner", "path_planner.type", "random"}}}),
            "<--set>:1: error: 'run.seed' is not of the form KEY=VALUE, such as run.seed=7\n"
            "<--set>:2: error: 'run..seed' is no key: a name is missing between its dots\n"
            "<--set>:3: error: 'schema' cannot be set: it belongs to a file\n"
            "<--set>:5: error: 'run.seed' is set twice; it was set by <--set>:4 already\n"
            "<--set>:6: error: 'run.seed.x' is set twice; it was set by <--set>:4 already\n"
            "<--set>:7: error: invalid YAML: end of sequence flow not found\n"
            "<--set>:8: error: unknown key 'ru'; did you mean 'run'?\n"
            "<--set>:9: error: run.threads must be an integer, got nothing\n"
            "<--seed>: error: 'run.seed' is set twice; it was set by <--set>:4 already\n"
            "<--path-planner>: error: 'random' is a sequence_planner, not a path_planner\n");
}

}  // namespace
}  // namespace dismantle
