#include "store/owner.h"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <fstream>
#include <sstream>

namespace dismantle::bench {
namespace {

/// Start time of the process in clock ticks since boot; empty when there is no such process.
std::string beginning_of(int pid) {
  std::ifstream in(fmt::format("/proc/{}/stat", pid));
  std::ostringstream text;
  text << in.rdbuf();
  const std::string stat = text.str();
  const std::size_t name_ends = stat.rfind(')');  // the name may contain any character
  if (name_ends == std::string::npos) return "";
  std::istringstream fields(stat.substr(name_ends + 1));
  std::string field;
  for (int i = 3; i <= 22 && fields >> field; ++i) {
    if (i == 3 && (field == "Z" || field == "X")) return "";
  }
  return field;
}

}  // namespace

std::string this_host() {
  char name[256] = {};
  ::gethostname(name, sizeof name - 1);
  std::string boot;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
  return fmt::format("{} {}", name, boot);
}

std::string this_owner() { return fmt::format("{}:{}", ::getpid(), beginning_of(::getpid())); }

bool is_alive(const std::string& owner) {
  const std::size_t colon = owner.find(':');
  int pid = 0;
  std::from_chars(owner.data(), owner.data() + std::min(colon, owner.size()), pid);
  return pid > 0 && colon != std::string::npos && beginning_of(pid) == owner.substr(colon + 1);
}

std::string cpu_model() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
  return "";
}

}  // namespace dismantle::bench
