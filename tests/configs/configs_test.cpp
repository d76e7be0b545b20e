// Law: every file in configs/ is a valid configuration, and what it resolves to is one as well.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "dismantle/host/config.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> config_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(CONFIGS_FOLDER))
    if (entry.path().extension() == ".yaml" && entry.path().parent_path().filename() != "bench")  // suites: tests/benchmark
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

RunConfig load(const fs::path& file) {
  Registry registry;
  return load_config({file, {}, {}}, registry);
}

TEST(Configs, AreThere) { EXPECT_GE(config_files().size(), 4u); }

TEST(Configs, EachLoads) {
  for (const auto& file : config_files()) {
    try {
      load(file);
    } catch (const ConfigError& e) {
      ADD_FAILURE() << e.what();
    }
  }
}

TEST(Configs, EachResolvedFileLoads) {
  const fs::path scratch = fs::temp_directory_path() / ("dismantle_configs_" + std::to_string(getpid()) + ".yaml");
  for (const auto& file : config_files()) {
    Registry registry;
    const RunConfig config = load_config({file, {}, {}}, registry);
    std::ofstream(scratch) << resolved_yaml(config, registry, scratch.parent_path());
    const RunConfig again = load(scratch);
    EXPECT_EQ(config.sections, again.sections) << file;
    EXPECT_EQ(config.simulator.params, again.simulator.params) << file;
    EXPECT_EQ(config.path_planner.params, again.path_planner.params) << file;
    EXPECT_EQ(config.sequence_planner.params, again.sequence_planner.params) << file;
    EXPECT_EQ(config.transfer_planner.params, again.transfer_planner.params) << file;
    ASSERT_EQ(config.layout.poses.size(), again.layout.poses.size()) << file;
    for (const auto& [part, pose] : config.layout.poses) {
      EXPECT_EQ(pose.t, again.layout.poses.at(part).t) << file;
      EXPECT_EQ(pose.q.coeffs(), again.layout.poses.at(part).q.coeffs()) << file;
    }
  }
  fs::remove(scratch);
}

// default.yaml documents the defaults: it must not differ from them.
TEST(Configs, DefaultSaysWhatIsTheDefault) {
  Registry registry;
  const RunConfig none = load_config({}, registry);
  const RunConfig file = load(fs::path(CONFIGS_FOLDER) / "default.yaml");
  EXPECT_EQ(none.sections, file.sections);
  EXPECT_EQ(none.simulator.type, file.simulator.type);
  EXPECT_EQ(none.simulator.params, file.simulator.params);
  EXPECT_EQ(none.path_planner.type, file.path_planner.type);
  EXPECT_EQ(none.path_planner.params, file.path_planner.params);
  EXPECT_EQ(none.sequence_planner.type, file.sequence_planner.type);
  EXPECT_EQ(none.sequence_planner.params, file.sequence_planner.params);
  EXPECT_EQ(none.transfer_planner.type, file.transfer_planner.type);
  EXPECT_EQ(none.transfer_planner.params, file.transfer_planner.params);
}

}  // namespace
}  // namespace dismantle
