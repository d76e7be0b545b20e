/// Runs a program that may crash, hang or take too much, and hands over what it writes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace dismantle::reader_process {

struct ChildLimits {
  double seconds = 0;        ///< of wall-clock time and of CPU time; 0 = no limit
  std::uint64_t memory = 0;  ///< bytes of address space; 0 = no limit
};

struct ChildEnd {
  enum class How {
    exited,       ///< with `code`
    crashed,      ///< by signal `code`
    timed_out,    ///< killed after ChildLimits::seconds
    stopped,      ///< killed because the caller asked to stop or refused the output
    not_started,  ///< `code` is the errno
  };
  How how = How::not_started;
  int code = 0;
  std::string messages;  ///< the end of what it wrote to standard error
};

/// Starts `program` with `arguments`, without a shell. `take` gets its standard output piece by piece; when it returns
/// false, the child is killed. `should_stop` is asked several times a second. The child is gone when this returns or
/// throws.
ChildEnd run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   const ChildLimits& limits, const std::function<bool()>& should_stop,
                   const std::function<bool(std::span<const std::byte>)>& take);

}  // namespace dismantle::reader_process
