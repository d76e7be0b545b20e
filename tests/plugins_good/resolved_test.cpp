// Law: resolved.yaml, loaded again, gives the same configuration and the same resolved values.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "dismantle/host/config.h"
#include "dismantle/run_context.h"
#include "scratch.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

class Resolved : public testing_support::Scratch {
 protected:
  std::string resolved(const RunConfig& config, const fs::path& folder = ".") {
    return resolved_yaml(config, registry_, folder);
  }
  static void expect_same(const RunConfig& a, const RunConfig& b) {
    EXPECT_EQ(a.simulator.type, b.simulator.type);
    EXPECT_EQ(a.simulator.parameters, b.simulator.parameters);
    EXPECT_EQ(a.path_planner.type, b.path_planner.type);
    EXPECT_EQ(a.path_planner.parameters, b.path_planner.parameters);
    EXPECT_EQ(a.sequence_planner.type, b.sequence_planner.type);
    EXPECT_EQ(a.sequence_planner.parameters, b.sequence_planner.parameters);
    EXPECT_EQ(a.transfer_planner.type, b.transfer_planner.type);
    EXPECT_EQ(a.transfer_planner.parameters, b.transfer_planner.parameters);
    EXPECT_EQ(a.provers, b.provers);
    EXPECT_EQ(a.objective, b.objective);
    ASSERT_EQ(a.layout.poses.size(), b.layout.poses.size());
    for (const auto& [part, pose] : a.layout.poses) {
      EXPECT_EQ(pose.t, b.layout.poses.at(part).t);
      EXPECT_EQ(pose.q.coeffs(), b.layout.poses.at(part).q.coeffs());
    }
    EXPECT_EQ(a.sections, b.sections);
    EXPECT_EQ(a.constraints, b.constraints);
    EXPECT_EQ(a.run.seed, b.run.seed);
    EXPECT_EQ(a.verify.max_penetration, b.verify.max_penetration);
  }
};

std::string without_comments(const std::string& yaml) {
  std::string out;
  std::istringstream lines(yaml);
  for (std::string line; std::getline(lines, line);) {
    line.erase(std::min(line.find("  #"), line.size()));
    while (!line.empty() && line.back() == ' ') line.pop_back();
    if (!line.empty() && line[0] != '#') out += line + "\n";
  }
  return out;
}

ParamValue random_value(const ParamSpec& spec, Rng& rng) {
  switch (spec.type) {
    case ParamType::boolean:
      return rng.below(2) == 0;
    case ParamType::integer: {
      const double lo = spec.min.value_or(-1e6), hi = std::min(spec.max.value_or(1e6), lo + 1e6);
      return static_cast<std::int64_t>(lo + std::floor(rng.uniform() * (hi - lo)));
    }
    case ParamType::number: {
      if (!spec.min) return rng.normal() * std::pow(10.0, rng.uniform(-30, 30));
      const double span = spec.max ? *spec.max - *spec.min : std::pow(10.0, rng.uniform(-20, 20));
      return *spec.min + span * (1e-9 + 0.999 * rng.uniform());
    }
    case ParamType::choice:
      return spec.choices[rng.below(spec.choices.size())].name;
    case ParamType::text: {
      if (spec.name == "up") return rng.below(2) == 0 ? "-y" : "0.5,-1,2";  // read as a direction
      static const char* const pieces[] = {"a", " ",    ":", "#", "\"",   "'", "\\", "\n",   "\t",
                                           "1", "true", "~", "é", "日本", "{", "- ", "\x01", "|"};
      std::string text;
      for (std::uint64_t n = rng.below(8); n > 0; --n) text += pieces[rng.below(std::size(pieces))];
      return text;
    }
    case ParamType::plugin:
    case ParamType::plugins:
      break;  // drawn by the test itself
  }
  return false;
}

TEST_F(Resolved, Defaults) {
  const RunConfig config = load_config({}, registry_);
  const std::string text = resolved(config);
  EXPECT_NE(text.find("  seed: 1 "), std::string::npos) << text;
  EXPECT_NE(text.find("# default"), std::string::npos);
  EXPECT_NE(text.find("# plugin dismantle.fixture 0.1.0, libfixture.so, sha256 "), std::string::npos);
  EXPECT_EQ(text.find(GOOD_FOLDER), std::string::npos) << "holds a path of the build";
  expect_same(config, load_text(text));
}

TEST_F(Resolved, AnObjectiveRoundTrips) {
  const RunConfig none = load_text("schema: 1\nobjective: []\n");
  EXPECT_NE(resolved(none).find("\nobjective: []"), std::string::npos) << resolved(none);
  const RunConfig config =
      load_text("schema: 1\nobjective: [directions, {type: sagging, weight: 0.25, hands: 3, require: true}]\n");
  const std::string text = resolved(config);
  const RunConfig again = load_text(text);
  expect_same(config, again);
  ASSERT_EQ(again.objective.size(), 2u) << text;
  EXPECT_EQ(without_comments(resolved(again)), without_comments(text));
}

TEST_F(Resolved, SaysWhereValuesCameFrom) {
  write("base.yaml", "schema: 1\nrun: {seed: 4}\n");
  write("top.yaml", "schema: 1\nextends: base.yaml\nverify: {max_penetration: 0.002}\n");
  const std::string text = resolved(load("top.yaml", {"run.path_steps=5"}, {{"--timeout", "run.timeout", "9"}}));
  const std::pair<const char*, const char*> rows[] = {{"  seed: 4", "# base.yaml:2"},
                                                      {"  max_penetration: 0.002", "# top.yaml:3"},
                                                      {"  path_steps: 5", "# <--set>:1"},
                                                      {"  timeout: 9", "# <--timeout>"},
                                                      {"  threads: 0", "# default"}};
  for (const auto& [begin, comment] : rows) {
    const std::size_t at = text.find(std::string("\n") + begin + " ");
    ASSERT_NE(at, std::string::npos) << begin << "\n" << text;
    const std::string line = text.substr(at + 1, text.find('\n', at + 1) - at - 1);
    EXPECT_TRUE(line.ends_with(comment)) << line;
  }
}

TEST_F(Resolved, RandomValuesRoundTrip) {
  Rng rng(23);
  const char* const planners[] = {"bfs", "t_rrt"};
  const char* const sequences[] = {"blocking", "random"};
  registry_.scan();
  for (int round = 0; round < 300; ++round) {
    RunConfig config = load_config({std::nullopt,
                                    {std::string("path_planner.type=") + planners[rng.below(2)],
                                     std::string("sequence_planner.type=") + sequences[rng.below(2)]},
                                    {}},
                                   registry_);
    const auto fill = [&rng](const std::vector<ParamSpec>& specs, ParamSet& params) {
      for (const auto& spec : specs) {
        params[spec.name] = random_value(spec, rng);
        ASSERT_FALSE(spec.problem_with(params[spec.name])) << spec.name << " " << *spec.problem_with(params[spec.name]);
      }
    };
    for (const auto& [name, specs] : fixed_sections()) fill(specs, config.sections[name]);
    fill(registry_.find("sdf_penalty").type.params, config.simulator.parameters);
    fill(registry_.find(config.path_planner.type).type.params, config.path_planner.parameters);
    fill(registry_.find(config.sequence_planner.type).type.params, config.sequence_planner.parameters);
    for (auto n = rng.below(3); n > 0; --n)
      config.layout.poses["part \"" + std::to_string(rng.below(9)) + "\"\n: x"] = {
          {rng.normal(), 1e9 * rng.normal(), rng.normal()},
          rotation_from_vector({rng.normal(), rng.normal(), rng.normal()})};
    unsigned drawn = 0;  // no name twice: constraints that contradict each other are refused
    const auto names = [&rng, &drawn](std::size_t least) {
      std::vector<std::string> list;
      for (auto n = least + rng.below(3); n > 0; --n) list.push_back("p: \"" + std::to_string(++drawn) + "'");
      return list;
    };
    config.constraints.base = names(0);
    config.constraints.ignore = names(0);
    for (auto n = rng.below(3); n > 0; --n) config.constraints.together.push_back(names(2));
    for (auto n = rng.below(3); n > 0; --n) config.constraints.before.push_back(names(2));
    if (rng.below(2) == 0) config.constraints.target = names(1).front();
    config.run.seed = std::get<std::int64_t>(config.sections["run"]["seed"]);
    config.verify.max_penetration = std::get<double>(config.sections["verify"]["max_penetration"]);
    const std::string text = resolved(config);
    const RunConfig again = load_text(text);
    expect_same(config, again);
    EXPECT_EQ(without_comments(resolved(again)), without_comments(text));
    if (HasFailure()) FAIL() << text;
  }
}

// Law: whatever plugins hold each other, the resolved file names every value, and gives the same configuration.
TEST_F(Resolved, NestedChoicesRoundTrip) {
  const RunConfig preset = load_text("schema: 1\npath_planner: {type: duo, of: {t_rrt: {range: 0.75}}}\n");
  const std::string text = resolved(preset);
  const std::pair<const char*, const char*> rows[] = {{"  type: duo ", "# run.yaml:2"},
                                                      {"  # preset of team, sha256 ", "libfixture.so"},
                                                      {"      # plugin dismantle.fixture 0.1.0", ""},
                                                      {"    - type: t_rrt ", "# preset duo"},
                                                      {"      range: 0.75 ", "# run.yaml:2"},
                                                      {"      goal_bias: 0.25 ", "# preset duo"},
                                                      {"      note: \"none\" ", "# preset duo"},
                                                      {"  last:", ""},
                                                      {"    similarity_translation: 0.05 ", "# preset duo"}};
  for (const auto& [begin, end] : rows) {
    const std::size_t at = text.find(std::string("\n") + begin);
    ASSERT_NE(at, std::string::npos) << begin << "\n" << text;
    const std::string line = text.substr(at + 1, text.find('\n', at + 1) - at - 1);
    EXPECT_NE(line.find(end), std::string::npos) << line;
  }
  expect_same(preset, load_text(text));
  EXPECT_EQ(without_comments(resolved(load_text(text))), without_comments(text));

  Rng rng(29);
  const std::vector<std::string> plain = {"bfs", "t_rrt", "guided"};
  const std::function<PluginChoice(int)> draw = [&](int depth) {
    PluginChoice choice{depth > 0 && rng.below(2) == 0 ? "team" : plain[rng.below(plain.size())], {}, {}};
    for (const auto& spec : registry_.find(choice.type).type.params) {
      if (spec.type == ParamType::plugin) {
        choice.parameters[spec.name] = draw(depth - 1);
      } else if (spec.type == ParamType::plugins) {
        std::vector<PluginChoice> list;
        for (auto n = 1 + rng.below(3); n > 0; --n) {
          list.push_back(draw(depth - 1));
          for (const auto& option : spec.options) list.back().options[option.name] = random_value(option, rng);
        }
        choice.parameters[spec.name] = list;
      } else {
        choice.parameters[spec.name] = random_value(spec, rng);
      }
    }
    return choice;
  };
  for (int round = 0; round < 100; ++round) {
    RunConfig config = load_config({}, registry_);
    config.path_planner = draw(3);
    expect_same(config, load_text(resolved(config)));
    if (HasFailure()) FAIL() << resolved(config);
  }
}

TEST_F(Resolved, SearchPathsStayRelative) {
  fs::create_directory_symlink(fs::path(GOOD_FOLDER) / "acme", "acme");
  fs::copy(fs::path(GOOD_FOLDER) / "acme", "copied", fs::copy_options::recursive);
  write("run.yaml", "schema: 1\nplugins: {search_paths: [copied]}\npath_planner: {type: acme.straight}\n");
  const RunConfig config = load("run.yaml");
  fs::create_directories("out/deep");
  const std::string text = resolved(config, "out/deep");
  EXPECT_NE(text.find("    - \"../../copied\"\n"), std::string::npos) << text;
  write("out/deep/resolved.yaml", text);
  expect_same(config, load("out/deep/resolved.yaml"));
}

TEST_F(Resolved, SameConfigurationSameBytes) {
  EXPECT_EQ(resolved(load_config({}, registry_)), resolved(load_config({}, registry_)));
}

}  // namespace
}  // namespace dismantle
