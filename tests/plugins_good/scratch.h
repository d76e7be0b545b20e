/// A folder for one test's files, and the registry of stand-ins.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "dismantle/host/config.h"

namespace dismantle::testing_support {

/// Works inside a folder of its own, so that messages hold relative names only.
class Scratch : public testing::Test {
 protected:
  Scratch() : before_(std::filesystem::current_path()) {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("dismantle_" + std::to_string(getpid()) + "_" + info->test_suite_name() + "_" + info->name());
    std::filesystem::create_directories(folder_);
    std::filesystem::current_path(folder_);
  }
  ~Scratch() override {
    std::filesystem::current_path(before_);
    std::filesystem::remove_all(folder_);
  }

  static void write(const std::filesystem::path& name, const std::string& text) {
    if (name.has_parent_path()) std::filesystem::create_directories(name.parent_path());
    std::ofstream(name, std::ios::binary) << text;
  }

  RunConfig load(const std::string& file, std::vector<std::string> set = {}, std::vector<ConfigOption> options = {}) {
    return load_config({file, std::move(set), std::move(options)}, registry_);
  }
  RunConfig load_text(const std::string& text, std::vector<std::string> set = {}) {
    write("run.yaml", text);
    return load("run.yaml", std::move(set));
  }
  /// All messages; empty when the configuration is good.
  std::string errors(const ConfigSource& source) {
    try {
      load_config(source, registry_);
    } catch (const ConfigError& e) {
      return e.what() + std::string("\n");
    }
    return "";
  }
  std::string errors_of(const std::string& text, std::vector<std::string> set = {}) {
    write("run.yaml", text);
    return errors({"run.yaml", std::move(set), {}});
  }

  Registry registry_{std::filesystem::path(GOOD_FOLDER) / "built_in"};
  std::filesystem::path folder_;

 private:
  std::filesystem::path before_;
};

}  // namespace dismantle::testing_support
