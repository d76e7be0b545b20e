// Law: every file in configs/ is a valid configuration, and what it resolves to is one as well.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <regex>
#include <string>
#include <vector>

#include "dismantle/host/config.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> config_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(CONFIGS_FOLDER))
    if (entry.path().extension() == ".yaml" &&
        entry.path().parent_path().filename() != "bench" &&      // suites: tests/benchmark
        entry.path().parent_path().filename() != "languages" &&  // of the book: lib/book
        entry.path().string().find("/presets/") == std::string::npos)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// The plugin that this build leaves out and the configuration names; empty when it can be loaded.
std::string missing_type(const fs::path& file) {
  std::ifstream stream(file);
  const std::regex type(R"(\btype:\s*([\w.]+))");
  const std::string all = std::string(",") + MISSING_TYPES + ",";
  for (std::string line; std::getline(stream, line);) {
    line = line.substr(0, line.find('#'));
    for (std::sregex_iterator named(line.begin(), line.end(), type); named != std::sregex_iterator(); ++named)
      if (all.find("," + (*named)[1].str() + ",") != std::string::npos) return (*named)[1];
  }
  return "";
}

/// All files but those that name a plugin that is left out.
std::vector<fs::path> usable_files() {
  std::vector<fs::path> files = config_files();
  std::erase_if(files, [](const fs::path& file) {
    const std::string type = missing_type(file);
    if (!type.empty()) std::cout << "left out: " << file.filename() << " needs " << type << '\n';
    return !type.empty();
  });
  return files;
}

RunConfig load(const fs::path& file) {
  Registry registry;
  return load_config({file, {}, {}}, registry);
}

TEST(Configs, AreThere) { EXPECT_GE(config_files().size(), 4u); }

TEST(Configs, EachLoads) {
  for (const auto& file : usable_files()) {
    try {
      const RunConfig config = load(file);
      for (const auto& warning : config.warnings) ADD_FAILURE() << warning;
    } catch (const ConfigError& e) {
      ADD_FAILURE() << e.what();
    }
  }
}

TEST(Configs, EachResolvedFileLoads) {
  const fs::path scratch = fs::temp_directory_path() / ("dismantle_configs_" + std::to_string(getpid()) + ".yaml");
  for (const auto& file : usable_files()) {
    Registry registry;
    const RunConfig config = load_config({file, {}, {}}, registry);
    std::ofstream(scratch) << resolved_yaml(config, registry, scratch.parent_path());
    const RunConfig again = load(scratch);
    EXPECT_EQ(config.sections, again.sections) << file;
    EXPECT_EQ(config.simulator.parameters, again.simulator.parameters) << file;
    EXPECT_EQ(config.path_planner.parameters, again.path_planner.parameters) << file;
    EXPECT_EQ(config.sequence_planner.parameters, again.sequence_planner.parameters) << file;
    EXPECT_EQ(config.transfer_planner.parameters, again.transfer_planner.parameters) << file;
    ASSERT_EQ(config.layout.poses.size(), again.layout.poses.size()) << file;
    for (const auto& [part, pose] : config.layout.poses) {
      EXPECT_EQ(pose.t, again.layout.poses.at(part).t) << file;
      EXPECT_EQ(pose.q.coeffs(), again.layout.poses.at(part).q.coeffs()) << file;
    }
  }
  fs::remove(scratch);
}

// Law: each file in configs/presets is a preset that can be used, and made.
TEST(Configs, EachPresetIsAType) {
  Registry registry;
  registry.scan();
  registry.load_all();
  for (const auto& problem : registry.problems()) ADD_FAILURE() << problem.file << ": " << problem.message;
  const fs::path folder = fs::path(CONFIGS_FOLDER) / "presets";
  for (const PluginKind kind : kPluginKinds) {
    if (!fs::is_directory(folder / to_string(kind))) continue;
    for (const auto& entry : fs::directory_iterator(folder / to_string(kind))) {
      const RegisteredType* type = registry.lookup(kind, entry.path().stem().string());
      ASSERT_NE(type, nullptr) << entry.path();
      EXPECT_FALSE(type->preset_of.empty()) << entry.path();
      EXPECT_TRUE(fs::equivalent(type->preset_file, entry.path())) << type->preset_file;
      if (kind == PluginKind::path_planner) {
        EXPECT_NE(registry.create<PathPlanner>(type->type.id), nullptr);
      }
    }
  }
}

// default.yaml documents the defaults: it must not differ from them.
TEST(Configs, DefaultSaysWhatIsTheDefault) {
  Registry registry;
  const RunConfig none = load_config({}, registry);
  const RunConfig file = load(fs::path(CONFIGS_FOLDER) / "default.yaml");
  EXPECT_EQ(none.sections, file.sections);
  EXPECT_EQ(none.simulator.type, file.simulator.type);
  EXPECT_EQ(none.simulator.parameters, file.simulator.parameters);
  EXPECT_EQ(none.path_planner.type, file.path_planner.type);
  EXPECT_EQ(none.path_planner.parameters, file.path_planner.parameters);
  // run.force: last_resort appends least_cut to the default planner, and run.best_order puts both into a best_order;
  // the file writes it out.
  EXPECT_EQ(none.run.force, ForceWhen::last_resort);
  EXPECT_TRUE(none.run.best_order);
  ASSERT_EQ(file.sequence_planner.type, "best_order");
  const auto& of = std::get<PluginChoice>(file.sequence_planner.parameters.at("of"));
  ASSERT_EQ(of.type, "chain");
  const auto& chain = std::get<std::vector<PluginChoice>>(of.parameters.at("of"));
  ASSERT_EQ(chain.size(), 2u);
  EXPECT_EQ(none.sequence_planner.type, chain[0].type);
  EXPECT_EQ(none.sequence_planner.parameters, chain[0].parameters);
  EXPECT_EQ(chain[1].type, "least_cut");
  EXPECT_EQ(none.objective, file.objective);
  EXPECT_FALSE(none.objective.empty());
  EXPECT_EQ(none.transfer_planner.type, file.transfer_planner.type);
  EXPECT_EQ(none.transfer_planner.parameters, file.transfer_planner.parameters);
}

}  // namespace
}  // namespace dismantle
