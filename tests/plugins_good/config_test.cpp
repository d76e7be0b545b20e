// Binding: defaults, all errors at once with their places, kinds and capabilities.
#include "dismantle/host/config.h"

#include <gtest/gtest.h>

#include "dismantle/run_context.h"
#include "scratch.h"

namespace dismantle {
namespace {

class Config : public testing_support::Scratch {};

TEST_F(Config, DefaultsWithoutAnyFile) {
  const RunConfig config = load_config({}, registry_);
  EXPECT_EQ(config.simulator.type, "sdf_penalty");
  EXPECT_EQ(config.path_planner.type, "guided");
  EXPECT_EQ(config.sequence_planner.type, "blocking");
  EXPECT_EQ(config.run.seed, 1);
  EXPECT_EQ(config.run.threads, 0u);
  EXPECT_EQ(config.run.path_timeout, 120);
  EXPECT_EQ(config.run.path_steps, 0);
  EXPECT_EQ(config.run.timeout, 7200);
  EXPECT_EQ(config.verify.max_penetration, 0.001);
  EXPECT_EQ(config.assembly.subdivide, PrepareOptions{}.subdivide);
  EXPECT_EQ(std::get<std::string>(config.path_planner.parameters.at("motion")), "auto");
  EXPECT_EQ(config.origins.at("run.seed"), "default");
}

TEST_F(Config, ReadsEverySection) {
  const RunConfig config = load_text(R"(schema: 1
assembly: {subdivide: 0.25, drop_duplicates: false}
simulator: {type: sdf_penalty, contact_stiffness: 2.0e6, time_step: 1.0e-3}
path_planner: {type: t_rrt, goal_bias: 0.2, max_nodes: 77, greedy: true, note: "a: b # c"}
sequence_planner: {type: random, attempts: 9}
run: {seed: 5, threads: 2, path_timeout: 1, path_steps: 1000, timeout: 2.5}
verify: {max_penetration: 0.001, advanced: {tests: 5000, trial_share: 0.5}}
)");
  EXPECT_EQ(config.assembly.subdivide, 0.25);
  EXPECT_FALSE(config.assembly.drop_duplicates);
  EXPECT_EQ(std::get<double>(config.simulator.parameters.at("contact_stiffness")), 2e6);
  EXPECT_EQ(std::get<double>(config.path_planner.parameters.at("goal_bias")), 0.2);
  EXPECT_EQ(std::get<std::int64_t>(config.path_planner.parameters.at("max_nodes")), 77);
  EXPECT_EQ(std::get<std::string>(config.path_planner.parameters.at("note")), "a: b # c");
  EXPECT_EQ(std::get<std::int64_t>(config.sequence_planner.parameters.at("attempts")), 9);
  EXPECT_EQ(config.run.seed, 5);
  EXPECT_EQ(config.run.threads, 2u);
  EXPECT_EQ(config.run.path_steps, 1000);
  EXPECT_EQ(config.run.timeout, 2.5);
  EXPECT_EQ(config.verify.max_penetration, 0.001);
  EXPECT_EQ(config.verify.budget.tests, 5000u);
  EXPECT_EQ(config.verify.budget.trial_share, 0.5);
  EXPECT_EQ(config.verify.budget.patches, VerifyBudget{}.patches);
  EXPECT_EQ(config.origins.at("run.seed"), "run.yaml:6");
}

std::vector<std::string> ids_of(const std::vector<PluginChoice>& choices) {
  std::vector<std::string> ids;
  for (const auto& c : choices) ids.push_back(c.type);
  return ids;
}

TEST_F(Config, ProversAreAListOfIdsOrOfMapsWithParameters) {
  using Ids = std::vector<std::string>;
  EXPECT_EQ(ids_of(load_config({}, registry_).provers), (Ids{"overlap_lock", "ring"})) << "those that are there";
  EXPECT_EQ(ids_of(load_text("schema: 1\nimmobility: {provers: [ring, overlap_lock]}\n").provers),
            (Ids{"ring", "overlap_lock"}))
      << "in that order";
  EXPECT_TRUE(load_text("schema: 1\nimmobility: {provers: []}\n").provers.empty());
  EXPECT_TRUE(load_text("schema: 1\n", {"immobility.provers=[]"}).provers.empty());
  const RunConfig config = load_text("schema: 1\nimmobility: {provers: [{type: ring, max_rings: 7}, overlap_lock]}\n");
  EXPECT_EQ(ids_of(config.provers), (Ids{"ring", "overlap_lock"}));
  EXPECT_EQ(std::get<std::int64_t>(config.provers[0].parameters.at("max_rings")), 7);
  EXPECT_EQ(config.origins.at("immobility.provers.0.type"), "run.yaml:2");
}

TEST_F(Config, WhatIsWrongWithProvers) {
  const auto expect = [&](const std::string& section, const std::vector<std::string>& said) {
    const std::string errors = errors_of("schema: 1\nimmobility: " + section + "\n");
    for (const std::string& text : said) EXPECT_NE(errors.find(text), std::string::npos) << text << "\nin: " << errors;
  };
  expect("{provers: [rings, ring, bfs, {max_rings: 1}], prove: 1}",
         {"run.yaml:2:24: error: unknown immobility_prover 'rings'; did you mean 'ring'?",
          "'bfs' is a path_planner, not an immobility_prover", "immobility.provers.3 has no 'type'",
          "unknown key 'prove' in immobility"});
  expect("{provers: [{type: ring, max_rings: 0}]}", {"immobility.provers.0.max_rings must be >= 1, got 0"});
  expect("{provers: [ring, overlap_lock, ring]}", {"run.yaml:2", "immobility.provers lists 'ring' twice"});
  expect("{provers: ring}", {"immobility.provers"});
  expect("[ring]", {"immobility must be a map of keys, not a list"});
}

/// Types and keys that are no more: the message says what to write instead.
TEST_F(Config, RemovedNames) {
  const auto expect = [&](const std::string& planner, const std::string& said) {
    const std::string errors = errors_of("schema: 1\npath_planner: " + planner + "\n");
    EXPECT_NE(errors.find(said), std::string::npos) << errors;
  };
  expect("{type: navigation_tree}",
         "run.yaml:2:22: error: unknown path_planner 'navigation_tree'; it was removed: leave it out of the list, or "
         "write 'guided'");
  expect("{type: t_rrt, overlap_reach: 3}",
         "run.yaml:2:29: error: unknown key 'overlap_reach' in path_planner (t_rrt); it was removed with "
         "navigation_tree: delete it");
}

TEST_F(Config, TheObjectiveIsAListOfChecksWithWeights) {
  using Ids = std::vector<std::string>;
  EXPECT_EQ(ids_of(load_config({}, registry_).objective), Ids{"directions"}) << "those of the default that are there";
  const std::string file = "schema: 1\nobjective: [{type: sagging, weight: 2, hands: 3, require: true}, directions]\n";
  const RunConfig config = load_text(file);
  ASSERT_EQ(ids_of(config.objective), (Ids{"sagging", "directions"}));
  EXPECT_EQ(config.objective[0].options, (ParamSet{{"weight", 2.0}, {"require", true}}));
  EXPECT_EQ(config.objective[0].parameters, (ParamSet{{"hands", std::int64_t{3}}}));
  EXPECT_EQ(config.objective[1].options, (ParamSet{{"weight", 1.0}, {"require", false}}));
  EXPECT_EQ(config.origins.at("objective.0.hands"), "run.yaml:2");
  EXPECT_EQ(config.origins.at("objective.1.weight"), "default");
  const RunConfig set = load_text(file, {"objective.directions.weight=0", "objective.0.hands=0"});
  EXPECT_EQ(set.objective[1].options.at("weight"), ParamValue{0.0});
  EXPECT_EQ(set.objective[0].parameters.at("hands"), ParamValue{std::int64_t{0}});
  EXPECT_EQ(ids_of(load_text(file, {"objective=[directions]"}).objective), (Ids{"directions"}));
  EXPECT_TRUE(load_text(file, {"objective=[]"}).objective.empty());
}

TEST_F(Config, WhatIsWrongWithAnObjective) {
  const auto expect = [&](const std::string& section, const std::vector<std::string>& said) {
    const std::string errors = errors_of("schema: 1\nobjective: " + section + "\n");
    for (const std::string& text : said) EXPECT_NE(errors.find(text), std::string::npos) << text << "\nin: " << errors;
  };
  expect("[{type: direction, weight: 1}, ring, {weight: 1}]",
         {"run.yaml:2:20: error: unknown step_check 'direction'; did you mean 'directions'?",
          "'ring' is an immobility_prover, not a step_check", "objective.2 has no 'type'"});
  expect(
      "[{type: sagging, weight: -1, hand: 2}, {type: directions, require: 1}]",
      {"objective.0.weight must be >= 0, got -1", "unknown key 'hand' in objective.0 (sagging); did you mean 'hands'?",
       "objective.1.require must be true or false, got '1'"});
  expect("[sagging, directions, {type: sagging, hands: 2}]", {"run.yaml:2", "objective lists 'sagging' twice"});
  expect("sagging", {"run.yaml:2:12: error: objective must be a list of step_checks, got a value"});
  expect("{sagging: {weight: 2}}", {"objective has no item 'sagging'; items are 0 (directions)"});
}

TEST_F(Config, AllErrorsAtOnce) {
  const std::string text = R"(schema: 1
simulater: {type: sdf_penalty}
assembly: {subdivide: big, normalise: true}
simulator: {type: sdf_penalty, contact_stiffness: -1, time_step: "0.1"}
path_planner: {type: t_rrt, goal_bais: 0.1, range: 0.5, range: 0.6, max_nodes: 1.5, greedy: yes, timeout: 3}
sequence_planner: {type: progresive}
run:
  seed: -4
  threads: 99999999999999999999
  path_timeout: [1, 2]
  timeout:
verify: 0.01
)";
  EXPECT_EQ(errors_of(text),
            R"(run.yaml:2:1: error: unknown key 'simulater'; did you mean 'simulator'?
run.yaml:3:23: error: assembly.subdivide must be a number, got 'big'
run.yaml:3:28: error: unknown key 'normalise' in assembly; did you mean 'normalize'?
run.yaml:4:51: error: simulator.contact_stiffness must be > 0, got -1 1/s^2 [sdf_penalty 0.1.0, libfixture.so]
run.yaml:4:66: error: simulator.time_step must be a number, got the text "0.1" [sdf_penalty 0.1.0, libfixture.so]
run.yaml:5:29: error: unknown key 'goal_bais' in path_planner (t_rrt); did you mean 'goal_bias'?
run.yaml:5:57: error: key 'range' is repeated; it stands at line 5 already
run.yaml:5:80: error: path_planner.max_nodes must be an integer, got '1.5' [t_rrt 0.1.0, libfixture.so]
run.yaml:5:93: error: path_planner.greedy must be true or false, got 'yes' [t_rrt 0.1.0, libfixture.so]
run.yaml:5:98: error: unknown key 'timeout' in path_planner (t_rrt); it belongs to run
run.yaml:6:26: error: unknown sequence_planner 'progresive'; did you mean 'progressive'?
run.yaml:8:9: error: run.seed must be >= 0, got -4
run.yaml:9:12: error: run.threads = 99999999999999999999 is too large for an integer of 64 bits
run.yaml:10:17: error: run.path_timeout must be a number, got a list
run.yaml:11:3: error: run.timeout must be a number, got nothing
run.yaml:12:9: error: verify must be a map of keys, not a value
)");
}

TEST_F(Config, Constraints) {
  const RunConfig config = load_text(
      "schema: 1\nconstraints: {base: [a], together: [[b, c]], before: [[d, e, f]], target: g, ignore: [h, i]}\n");
  const NamedConstraints expected{{"a"}, {{"b", "c"}}, {{"d", "e", "f"}}, "g", {"h", "i"}, {}, {}};
  EXPECT_EQ(config.constraints, expected);
  Assembly assembly;
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g"}) {
    assembly.parts.emplace_back();
    assembly.parts.back().id = static_cast<PartId>(assembly.parts.size() - 1);
    assembly.parts.back().name = name;
  }
  const Constraints ids = constraints_of(config.constraints, assembly);
  EXPECT_EQ(ids.before, (std::vector<std::pair<PartId, PartId>>{{3, 4}, {4, 5}}));
  EXPECT_EQ(ids.target, PartId{6});
  assembly.parts.pop_back();
  EXPECT_THROW(constraints_of(config.constraints, assembly), InputError);
  EXPECT_NE(errors_of("schema: 1\nconstraints: {base: a}\n").find("list of"), std::string::npos);
  EXPECT_NE(errors_of("schema: 1\nconstraints: {bse: [a]}\n").find("base"), std::string::npos);
  EXPECT_NE(errors_of("schema: 1\nconstraints: {together: [[a]]}\n").find("two or more"), std::string::npos);
}

TEST_F(Config, IdsOfTheWrongKind) {
  EXPECT_EQ(errors_of("schema: 1\npath_planner: {type: progressive}\nsimulator: {type: bfs}\n"),
            "run.yaml:2:22: error: 'progressive' is a sequence_planner, not a path_planner\n"
            "run.yaml:3:19: error: 'bfs' is a path_planner, not a simulator\n");
  EXPECT_EQ(errors_of("schema: 1\npath_planner: {type: [bfs]}\n"),
            "run.yaml:2:22: error: path_planner.type must be the id of a path_planner, got a list\n");
}

TEST_F(Config, Schema) {
  EXPECT_EQ(errors_of("run: {seed: 1}\n"), "run.yaml:1:1: error: missing key 'schema'; write 'schema: 1'\n");
  EXPECT_EQ(errors_of("schema: 2\n"),
            "run.yaml:1:9: error: schema 2 is not supported; this version of Dismantle reads 1: update Dismantle\n");
  EXPECT_EQ(errors_of("schema: one\n"), "run.yaml:1:9: error: schema must be the number 1\n");
  EXPECT_EQ(errors_of("schema: \"1\"\n"), "run.yaml:1:9: error: schema must be the number 1\n");
  EXPECT_NE(errors_of("- a\n- b\n").find("must be a map of keys, not a list"), std::string::npos);
}

TEST_F(Config, Capabilities) {
  EXPECT_EQ(errors_of("schema: 1\nsimulator: {type: geometry_only}\npath_planner: {type: bfs}\n"),
            "run.yaml:3:22: error: path_planner 'bfs' needs a simulator with dynamics, which 'geometry_only' does not "
            "have\n");
  EXPECT_EQ(errors_of("schema: 1\nsimulator: {type: geometry_only}\npath_planner: {type: pairs}\n"),
            "run.yaml:3:22: error: path_planner 'pairs' needs a simulator with 2 parts moving simultaneously, which "
            "'geometry_only' "
            "does not have\n");
  EXPECT_EQ(errors_of("schema: 1\nsimulator: {type: geometry_only}\npath_planner: {type: t_rrt}\n"), "");
}

// Law: naming one plugin never changes another.
TEST_F(Config, SectionsDoNotDependOnEachOther) {
  registry_.scan();
  const RunConfig plain = load_config({}, registry_);
  for (const RegisteredType* type : registry_.types(PluginKind::path_planner)) {
    if (type->type.id == "team") continue;  // it has no default
    const RunConfig config = load_text("schema: 1\npath_planner: {type: " + type->type.id + "}\n");
    EXPECT_EQ(config.path_planner.type, type->type.id);
    EXPECT_EQ(config.sequence_planner, plain.sequence_planner) << type->type.id;
    EXPECT_EQ(config.transfer_planner, plain.transfer_planner) << type->type.id;
  }
}

TEST_F(Config, Choices) {
  EXPECT_EQ(errors_of("schema: 1\npath_planner: {motion: rotaton}\n"),
            "run.yaml:2:24: error: path_planner.motion must be one of translation, rotation, auto; got 'rotaton'; did "
            "you mean "
            "'rotation'? [guided 0.1.0, libfixture.so]\n");
}

TEST_F(Config, SearchPathsAreRelativeToTheFile) {
  write("sub/run.yaml", "schema: 1\nplugins: {search_paths: [more]}\npath_planner: {type: acme.straight, force: 7}\n");
  std::filesystem::create_directory_symlink(std::filesystem::path(GOOD_FOLDER) / "acme", "sub/more");
  const RunConfig config = load("sub/run.yaml");
  EXPECT_EQ(config.path_planner.type, "acme.straight");
  ASSERT_EQ(config.plugin_search_paths.size(), 1u);
  EXPECT_EQ(config.plugin_search_paths[0], "sub/more");
  EXPECT_EQ(errors_of("schema: 1\nplugins: {search_paths: [nowhere], serch_paths: []}\n"),
            "run.yaml:2:26: error: plugin folder 'nowhere' does not exist\n"
            "run.yaml:2:36: error: unknown key 'serch_paths' in plugins; did you mean 'search_paths'?\n");
}

TEST_F(Config, UnreadableFiles) {
  EXPECT_EQ(errors({"absent.yaml", {}, {}}), "error: cannot read 'absent.yaml': No such file or directory\n");
  std::filesystem::create_directory("folder.yaml");
  EXPECT_EQ(errors({"folder.yaml", {}, {}}), "error: 'folder.yaml' is a folder, not a YAML file\n");
}

// Law: whatever stands in the file, a configuration or a ConfigError with places comes back.
TEST_F(Config, RandomMutations) {
  const std::string text =
      "schema: 1\nassembly: {subdivide: 0.25}\nsimulator: {type: sdf_penalty, contact_stiffness: 2.0e6}\n"
      "path_planner: {type: t_rrt, goal_bias: 0.2, note: \"x\"}\nrun:\n  seed: 5\n  timeout: 2.5\nverify: "
      "{max_penetration: 0.001}\n";
  const std::string spice = ":-?[]{}&*!|>'\"%#,\n\t ~0e.";
  Rng rng(17);
  int good = 0, bad = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string mutated = text;
    for (std::uint64_t n = 1 + rng.below(4); n > 0; --n) {
      const std::size_t at = rng.below(mutated.size());
      switch (rng.below(4)) {
        case 0:
          mutated.erase(at, 1 + rng.below(4));
          break;
        case 1:
          mutated.insert(at, 1, spice[rng.below(spice.size())]);
          break;
        case 2:
          mutated[at] = static_cast<char>(rng.below(256));
          break;
        default:
          mutated.insert(at, text.substr(rng.below(text.size()), rng.below(20)));
      }
    }
    try {
      load_text(mutated);
      ++good;
    } catch (const ConfigError& e) {
      ++bad;
      for (const auto& d : e.diagnostics()) EXPECT_FALSE(d.message.empty()) << mutated;
    }
  }
  EXPECT_GT(good, 0);
  EXPECT_GT(bad, good);
}

}  // namespace
}  // namespace dismantle
