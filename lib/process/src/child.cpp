#include "dismantle/process/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <system_error>
#include <utility>

#include "dismantle/errors.h"
#include "leftovers.h"

namespace dismantle::process {
namespace {

[[noreturn]] void fail(const std::string& what, int error) {
  throw Error(fmt::format("{}: {}", what, std::generic_category().message(error)));
}

/// False, with errno, when it cannot be set.
bool limit(__rlimit_resource what, rlim_t soft, rlim_t hard) {
  rlimit now = {};
  if (::getrlimit(what, &now) != 0) return false;
  const rlimit both = {std::min(soft, now.rlim_max), std::min(hard, now.rlim_max)};
  return ::setrlimit(what, &both) == 0;
}

bool limit_memory([[maybe_unused]] std::uint64_t bytes) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;
#else
  return bytes == 0 || limit(RLIMIT_AS, bytes, bytes);
#endif
}

/// Binds the life of the child to that of the parent, and separates it from the terminal's Ctrl-C.
void attach(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // the parent has ended already
  ::setpgid(0, 0);
}

/// The ends of the pipes of one child, closed with it.
struct Streams {
  int nothing = -1;
  std::array<int, 2> output{-1, -1}, messages{-1, -1}, failure{-1, -1};

  bool open(bool separate) {
    nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    return nothing >= 0 && (!separate || pipe(output)) && pipe(messages) && pipe(failure);
  }
  ~Streams() {
    for (const int fd : {nothing, output[0], output[1], messages[0], messages[1], failure[0], failure[1]})
      if (fd >= 0) ::close(fd);
  }

 private:
  /// The end for writing is above the standard streams, which the host may have closed.
  static bool pipe(std::array<int, 2>& ends) {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return false;
    const int low = ends[1];
    ends[1] = ::fcntl(low, F_DUPFD_CLOEXEC, 3);
    ::close(low);
    return ends[1] >= 0;
  }
};

/// Runs in the child between fork and exec: only async-signal-safe calls, because the host has other threads.
[[noreturn]] void become(char* const* command, char* const* environment, const Program& program, pid_t parent,
                         const Streams& streams) {
  attach(parent);
  const Limits& l = program.limits;
  const auto cpu = static_cast<rlim_t>(std::ceil(l.cpu));
  const int output = streams.output[1] >= 0 ? streams.output[1] : streams.messages[1];
  limit(RLIMIT_CORE, 0, 0);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  if (limit_memory(l.memory) && (l.cpu == 0 || limit(RLIMIT_CPU, cpu, cpu + 1)) &&  // SIGXCPU at the soft limit
      (l.file_size == 0 || limit(RLIMIT_FSIZE, l.file_size, l.file_size)) &&
      ::dup2(streams.nothing, STDIN_FILENO) >= 0 && ::dup2(output, STDOUT_FILENO) >= 0 &&
      ::dup2(streams.messages[1], STDERR_FILENO) >= 0) {
    ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
    ::execve(command[0], command, environment);
  }
  const int error = errno;
  (void)!::write(streams.failure[1], &error, sizeof error);
  ::_exit(127);
}

double seconds(const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); }

}  // namespace

Child::Child(const Program& program) : program_(program) {
  std::vector<char*> command, environment;
  for (auto& word : program_.command) command.push_back(word.data());
  command.push_back(nullptr);
  for (char** entry = environ; *entry != nullptr; ++entry) environment.push_back(*entry);
  if (program_.whole_tree) mark_ = new_mark();
  if (!mark_.empty()) environment.push_back(mark_.data());
  environment.push_back(nullptr);

  Streams streams;
  const pid_t parent = ::getpid();
  int error = 0;
  if (streams.open(program_.output != nullptr)) pid_ = ::fork();
  if (pid_ == 0) become(command.data(), environment.data(), program_, parent, streams);
  error = errno;
  const std::string what = fmt::format("cannot start {}", program_.command.front());
  if (pid_ < 0) fail(what, error);
  ::setpgid(pid_, pid_);  // in both processes, since either may run first
  ::close(std::exchange(streams.failure[1], -1));
  ssize_t n = 0;
  while ((n = ::read(streams.failure[0], &error, sizeof error)) < 0 && errno == EINTR) {
  }
  if (n == sizeof error) {
    reap(true);
    fail(what, error);
  }
  output_ = std::exchange(streams.output[0], -1);
  messages_ = std::exchange(streams.messages[0], -1);
  for (const int stream : {output_, messages_})
    if (stream >= 0) ::fcntl(stream, F_SETFL, O_NONBLOCK);
}

Child::Child(const Limits& limits) : program_{.command = {}, .limits = limits} {
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ < 0) fail("cannot start a child process", errno);
  if (pid_ > 0) {
    ::setpgid(pid_, pid_);
    return;
  }
  attach(parent);
  if (!limit_memory(limits.memory)) fail(fmt::format("memory cannot be limited to {} MiB", limits.memory >> 20), errno);
}

Child::~Child() {
  if (pid_ > 0) {
    kill();
    reap(true);
  }
  for (const int stream : {output_, messages_})
    if (stream >= 0) ::close(stream);
}

void Child::signal(int number) const {
  if (pid_ > 0) ::kill(pid_, number);
}

void Child::kill() const {
  if (pid_ > 0) ::kill(-pid_, SIGKILL);
}

void Child::read_streams(int rounds) {
  std::array<std::byte, 1 << 16> buffer;
  for (int* stream : {&output_, &messages_})
    for (int i = 0; i < rounds && *stream >= 0; ++i) {
      const ssize_t n = ::read(*stream, buffer.data(), buffer.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0 && errno == EAGAIN) break;
      if (n <= 0) {
        ::close(std::exchange(*stream, -1));
      } else if (stream == &output_) {
        if (end_.stopped || program_.output({buffer.data(), static_cast<std::size_t>(n)})) continue;
        end_.stopped = true;
        kill();
      } else {
        const std::size_t most = 4096;  // bytes that a report shows
        end_.last_words.append(reinterpret_cast<const char*>(buffer.data()), static_cast<std::size_t>(n));
        if (end_.last_words.size() > most) end_.last_words.erase(0, end_.last_words.size() - most);
      }
    }
}

bool Child::reap(bool block) {
  int status = 0;
  rusage usage = {};
  pid_t got = 0;
  while ((got = ::wait4(pid_, &status, block ? 0 : WNOHANG, &usage)) < 0 && errno == EINTR) {
  }
  if (got < 0 && !block) fail("the child process is lost", errno);
  if (got == 0) return false;
  kill();  // descendants that may still run
  pid_ = -1;
  if (!mark_.empty()) kill_marked(mark_);
  end_.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  end_.status = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  end_.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  end_.peak_rss_mb = double(usage.ru_maxrss) / 1024;
  return true;
}

bool Child::ended() {
  if (pid_ < 0) return true;
  read_streams(4);  // bounded: endless output must not defer the limits
  const Limits& l = program_.limits;
  end_.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  if (!reap(false)) {
    if (l.wall > 0 && end_.wall_seconds > l.wall && !end_.out_of_wall) {
      end_.out_of_wall = true;
      kill();
    }
    return false;
  }
  read_streams(64);                                // what it had written before it ended fits into a pipe
  if (end_.signal == 0) end_.out_of_wall = false;  // it ended by itself just before it was killed
  end_.out_of_cpu = l.cpu > 0 && !end_.out_of_wall &&
                    (end_.signal == SIGXCPU || (end_.signal == SIGKILL && end_.cpu_seconds >= l.cpu));
  return true;
}

void Child::wait(std::span<const Child* const> children) {
  std::vector<pollfd> streams;
  for (const Child* child : children)
    for (const int stream : {child->output_, child->messages_})
      if (stream >= 0) streams.push_back({stream, POLLIN, 0});
  // The end of a process without streams, or with a descendant that keeps them open, wakes nobody.
  ::poll(streams.data(), streams.size(), streams.empty() ? 5 : 50);
}

End run(const Program& program, const std::function<bool()>& should_stop) {
  Child child(program);
  bool stopped = false;
  while (!child.ended()) {
    if (!stopped && should_stop()) {
      stopped = true;
      child.kill();
    }
    const Child* const one[] = {&child};
    Child::wait(one);
  }
  End end = child.end();
  end.stopped = end.stopped || stopped;
  return end;
}

}  // namespace dismantle::process
