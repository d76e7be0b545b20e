/// A child process with limits, for work that may crash, hang or use too much memory.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace dismantle::process {

/// What a process may use; 0: no limit. A limit of the system or of the parent that is lower stays.
struct Limits {
  double wall = 0;              ///< seconds until the process group is killed
  double cpu = 0;               ///< CPU seconds, rounded up, until the system ends the process
  std::uint64_t memory = 0;     ///< bytes of address space; none in sanitizer builds, which reserve terabytes
  std::uint64_t file_size = 0;  ///< bytes of any file that it writes
};

/// What a child runs.
struct Program {
  std::vector<std::string> command;  ///< path and arguments; no shell
  Limits limits{};
  /// Receives the standard output piece by piece; false: kill the process. Without it, standard output and standard
  /// error are one stream.
  std::function<bool(std::span<const std::byte>)> output{};
  /// When the process has ended, also its descendants in other process groups are killed.
  bool whole_tree = false;
};

/// How a child ended.
struct End {
  int status = 0;  ///< exit status, when signal is 0
  int signal = 0;
  bool out_of_wall = false;  ///< killed by Child for Limits::wall
  bool out_of_cpu = false;   ///< ended by the system for Limits::cpu
  bool stopped = false;      ///< killed because Program::output refused, or by run() because its caller wanted to stop
  double wall_seconds = 0, cpu_seconds = 0;
  double peak_rss_mb = 0;  ///< MiB; at least the value of the parent process when it started the child
  std::string last_words;  ///< end of its standard error stream, at most 4 KiB
};

/// A running process in its own process group, so that Ctrl-C reaches only the parent. Its standard input is empty. It
/// is killed when the thread that started it ends, for any reason. After it has ended, its group is killed.
class Child {
 public:
  /// @throws Error when the program cannot be started.
  explicit Child(const Program& program);
  /// Continues in two processes: in the child, which keeps all streams, is_copy() is true. No other thread may run.
  /// @throws Error; also in the child, when its memory cannot be limited.
  explicit Child(const Limits& limits);
  ~Child();  ///< kills the process if it is still running
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  bool is_copy() const { return pid_ == 0; }

  /// Reads its streams and enforces the limit of wall-clock time. True when the process has ended; end() is then
  /// complete.
  bool ended();
  /// Waits until one of these processes has written something, closed a stream or ended, or for some milliseconds.
  static void wait(std::span<const Child* const> children);
  /// Kills the whole process group.
  void kill() const;
  /// Sends a signal to the process alone.
  void signal(int number) const;
  const End& end() const { return end_; }

 private:
  void read_streams(int rounds);
  bool reap(bool block);

  pid_t pid_ = -1;  // 0: this is the child; -1: it has ended
  int output_ = -1, messages_ = -1;
  Program program_;
  std::string mark_;  // in the environment of the process and its descendants
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  End end_;
};

/// Runs a program to its end. `should_stop` is polled several times a second. @throws Error when it cannot be started.
End run(const Program& program, const std::function<bool()>& should_stop);

}  // namespace dismantle::process
