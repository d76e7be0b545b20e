/// A child process for work that may crash, hang or use too much memory.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace dismantle::bench {

struct ChildSpec {
  std::vector<std::string> command;  ///< program and arguments
  double wall = 0;                   ///< seconds until its process group is killed
  double cpu = 0;                    ///< CPU seconds until it is killed
  std::int64_t memory = 0;           ///< MiB of address space
};

struct ChildEnd {
  int status = 0;  ///< exit status, when signal is 0
  int signal = 0;
  bool out_of_wall = false;  ///< killed by Child for its wall-clock limit
  bool out_of_cpu = false;   ///< the kernel killed it for its CPU limit
  double wall_seconds = 0, cpu_seconds = 0;
  double peak_rss_mb = 0;  ///< MiB; at least the value of the parent process when it started the child
  std::string last_words;  ///< end of its standard error stream, at most 4 KiB
};

/// A running process in its own process group. It is killed when the thread that started it ends, for any reason. After
/// it has ended, its remaining descendants are killed, whichever process group they are in.
class Child {
 public:
  /// @throws Error when it cannot be started.
  explicit Child(const ChildSpec& spec);
  ~Child();  ///< kills the process if it is still running
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// For poll(): readable when the process has written something or closes the stream. -1 once the stream is closed.
  int stream() const { return stream_; }
  /// Reads its output and enforces the wall-clock limit. True when the process has ended; end() is then complete.
  bool ended();
  /// Kills the whole process group.
  void kill();
  const ChildEnd& end() const { return end_; }

 private:
  void listen();
  std::string mark_;  // in the environment of the process and its descendants
  pid_t pid_ = -1;
  int stream_ = -1;
  bool done_ = false;
  double wall_, cpu_;
  std::chrono::steady_clock::time_point begin_;
  ChildEnd end_;
};

}  // namespace dismantle::bench
