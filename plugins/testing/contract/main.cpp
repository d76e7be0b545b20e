// Tests the laws of each plugin kind on all plugins that are found or named.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "selection.h"

namespace {

constexpr const char* kUsage =
    R"(usage: dismantle_contract_tests [--expect FILE] [--examples DIR] [--time-limit S] [--gtest_...] [FILE.so | ID]...

Tries the laws of simulators, path, sequence and transfer planners, immobility provers and importers on the types of the plugin files,
or the types with these ids; without any, on all that are found (the built-in folder, then DISMANTLE_PLUGIN_PATH).
Other plugins that are found serve as partners: a path planner is tried with the first simulator that has what it needs.
A law that does not concern a plugin, by the capabilities that it declares, is skipped; skips are listed at the end.
--expect FILE: what is known about some plugins beyond the laws, the skips among it (see tests/contract/expectations.txt).
--examples DIR: files of the formats that importers read; beside NAME.xyz may stand a folder NAME with an OBJ file for each part.
--time-limit S: seconds that one law may take before the plugin counts as hanging; default 600, 0 none.
DISMANTLE_TESTS=nightly makes random trials more numerous, without a limit of time.
Exit status: 0 all laws hold, 1 some do not, 2 wrong use or a plugin that is refused.
)";

/// "TakesApartWhatCanBeTakenApart/acme.x" as "acme.x: takes apart what can be taken apart".
std::string sentence_of(const std::string& law) {
  const std::size_t slash = law.find('/');
  std::string words;
  for (const char c : law.substr(0, slash)) {
    const bool upper = c >= 'A' && c <= 'Z';
    if (upper && !words.empty()) words += ' ';
    words += upper ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return (slash == std::string::npos ? "" : law.substr(slash + 1) + ": ") + words;
}

/// Collects the laws that do not hold, as sentences.
class Failures final : public testing::EmptyTestEventListener {
 public:
  void OnTestEnd(const testing::TestInfo& info) override {
    if (info.result()->Failed()) laws.push_back(sentence_of(info.name()));
  }
  std::vector<std::string> laws;
};

/// Collects the skipped tests and the reasons.
class Skips final : public testing::EmptyTestEventListener {
 public:
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (result.skipped()) reason_ = result.summary();
  }
  void OnTestStart(const testing::TestInfo&) override { reason_.clear(); }
  void OnTestEnd(const testing::TestInfo& info) override {
    if (!info.result()->Skipped()) return;
    std::string law = info.name();
    const std::size_t slash = law.rfind('/');
    if (slash != std::string::npos) law = law.substr(slash + 1) + " " + law.substr(0, slash);
    reasons[law] = reason_;
  }
  std::map<std::string, std::string> reasons;  ///< by "ID LAW"

 private:
  std::string reason_;
};

/// Time limit for one law in seconds; 0: no limit.
unsigned g_limit = 600;

/// "LAW/ID" of the current test, for on_crash.
char g_law[256] = "";

class CurrentLaw final : public testing::EmptyTestEventListener {
 public:
  void OnTestStart(const testing::TestInfo& info) override {
    std::strncpy(g_law, info.name(), sizeof g_law - 1);  // the rest stays zero
    ::alarm(g_limit);
    g_law[std::min(std::strlen(info.name()), sizeof g_law - 1)] = '\0';
  }
  void OnTestEnd(const testing::TestInfo&) override {
    ::alarm(0);
    g_law[0] = '\0';
  }
};

/// Reports a crash of the plugin as a failure of the current law. Uses only system calls.
extern "C" void on_crash(int number) {
  const auto say = [](const char* text) {
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) ::_exit(1);
  };
  if (number == SIGALRM) {
    say("\nFAILED: the plugin did not come back while this law was tried (--time-limit): ");
  } else {
    say("\nFAILED: the process crashed (");
    say(number == SIGABRT ? "SIGABRT" : number == SIGFPE ? "SIGFPE" : number == SIGSEGV ? "SIGSEGV" : "signal");
    say(") while this law was tried: ");
  }
  say(g_law[0] != '\0' ? g_law : "none, plugins were being loaded or unloaded");
  say("\nUnder a debugger: gdb --args dismantle_contract_tests FILE.so\n");
  ::_exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM}) std::signal(number, on_crash);
  const char* long_form = std::getenv("DISMANTLE_TESTS");
  if (long_form != nullptr && std::string_view(long_form) == "nightly") g_limit = 0;
  dismantle::contract::Selection selection;
  std::vector<char*> rest{argv[0]};
  bool whole = true;  // are all laws tried?
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "-h" || word == "--help") {
      std::cout << kUsage;
      return 0;
    }
    if (word == "--expect" && i + 1 < argc) {
      selection.expectations = argv[++i];
    } else if (word == "--examples" && i + 1 < argc) {
      selection.examples = argv[++i];
    } else if (word == "--time-limit" && i + 1 < argc) {
      g_limit = static_cast<unsigned>(std::strtoul(argv[++i], nullptr, 10));
    } else if (word.starts_with("--gtest")) {
      rest.push_back(argv[i]);
      if (word.starts_with("--gtest_filter")) whole = false;
    } else if (word.starts_with("-")) {
      std::cerr << "unknown option " << word << '\n' << kUsage;
      return 2;
    } else if (std::filesystem::exists(word)) {
      selection.files.emplace_back(word);
    } else {
      selection.ids.insert(word);
    }
  }
  try {
    dismantle::contract::select(selection);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
  int count = static_cast<int>(rest.size());
  testing::InitGoogleTest(&count, rest.data());
  auto* skips = new Skips;  // owned by Google Test
  testing::UnitTest::GetInstance()->listeners().Append(skips);
  auto* failures = new Failures;
  testing::UnitTest::GetInstance()->listeners().Append(failures);
  testing::UnitTest::GetInstance()->listeners().Append(new CurrentLaw);
  int status = RUN_ALL_TESTS();
  if (!failures->laws.empty()) std::cout << "\nLaws that do not hold (docs/plugin-kinds.md; what was seen is above):\n";
  for (const auto& law : failures->laws) std::cout << "  " << law << '\n';
  if (!skips->reasons.empty()) std::cout << "\nSkipped, by declared capabilities:\n";
  std::set<std::string> skipped;
  for (const auto& [law, reason] : skips->reasons) {
    std::cout << "  " << law << ": " << reason << '\n';
    skipped.insert(law);
  }
  for (const auto& id : dismantle::contract::without_defaults())
    std::cout << "Not tried, for it has parameters without a default: " << id << '\n';
  if (whole)
    for (const auto& difference : dismantle::contract::unexpected_skips(skipped)) {
      std::cout << "FAILED: " << difference << '\n';
      status = 1;
    }
  return status;
}
