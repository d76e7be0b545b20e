#include "plugins_check.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "dismantle/errors.h"

namespace dismantle::app {

void check_plugins(const std::vector<std::string>& plugins, const std::string& examples, bool verbose) {
  for (const std::string& plugin : plugins)
    if ((plugin.ends_with(".so") || plugin.find('/') != std::string::npos) && !std::filesystem::exists(plugin))
      throw Error(plugin + ": there is no such file");
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "dismantle_contract_tests";
  std::vector<std::string> words{program.string()};
  if (!verbose) words.push_back("--gtest_brief=1");
  if (!examples.empty()) words.insert(words.end(), {"--examples", examples});
  words.insert(words.end(), plugins.begin(), plugins.end());
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(program.c_str(), arguments.data());
  throw Error(program.string() + ": " + std::strerror(errno) +
              ". It is built with the tests (-DDISMANTLE_BUILD_TESTS=ON) and installed with them.");
}

}  // namespace dismantle::app
