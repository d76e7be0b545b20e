#include "leftovers.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

namespace dismantle::process {
namespace {

namespace fs = std::filesystem;

/// Environment of a process of this user; empty when the process has ended or belongs to another user.
std::string environment_of(const fs::path& process) {
  std::ifstream in(process / "environ", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool has(std::string_view environment, std::string_view mark) {
  for (std::size_t at = environment.find(mark); at != std::string_view::npos; at = environment.find(mark, at + 1)) {
    const bool begins = at == 0 || environment[at - 1] == '\0';
    const std::size_t end = at + mark.size();
    if (begins && (end == environment.size() || environment[end] == '\0')) return true;
  }
  return false;
}

/// One pass over the processes. True when one of them had the mark.
bool kill_once(const std::string& mark) {
  bool found = false;
  std::error_code error;
  for (fs::directory_iterator at("/proc", error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename();
    pid_t pid = 0;
    const auto [last, problem] = std::from_chars(name.data(), name.data() + name.size(), pid);
    if (problem != std::errc{} || last != name.data() + name.size() || pid == ::getpid()) continue;
    if (!has(environment_of(at->path()), mark)) continue;
    found = ::kill(pid, SIGKILL) == 0 || found;
  }
  return found;
}

}  // namespace

std::string new_mark() {
  static std::atomic<std::uint64_t> count{0};
  const auto begun = std::chrono::steady_clock::now().time_since_epoch().count();
  return fmt::format("DISMANTLE_PROCESS={}.{}.{}", ::getpid(), begun, count++);
}

void kill_marked(const std::string& mark) {
  constexpr int kMostRounds = 1000;  // about one second; a process that forks faster than this loop kills survives
  for (int round = 0; round < kMostRounds && kill_once(mark); ++round) ::usleep(1000);  // they take time to disappear
}

}  // namespace dismantle::process
