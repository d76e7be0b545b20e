/// Runs a program that may crash, hang or use too much memory, and passes on its output.
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
  std::string messages;  ///< the last part of its standard error
};

/// Starts `program` with `arguments`, without a shell. `take` receives its standard output piece by piece and returns
/// false to kill the child. `should_stop` is polled several times a second. The child has ended when this returns or
/// throws.
ChildEnd run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   const ChildLimits& limits, const std::function<bool()>& should_stop,
                   const std::function<bool(std::span<const std::byte>)>& take);

}  // namespace dismantle::reader_process
