#include "process/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <system_error>

#include "dismantle/errors.h"
#include "process/leftovers.h"

namespace dismantle::bench {
namespace {

double seconds(const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); }

void limit(int what, rlim_t soft, rlim_t hard) {
  const rlimit value = {soft, hard};
  if (::setrlimit(static_cast<__rlimit_resource>(what), &value) != 0) _exit(127);
}

/// Runs between fork and exec, where only system calls are safe.
[[noreturn]] void become(char* const* command, char* const* environment, const ChildSpec& spec, pid_t parent,
                         int stream, int nothing) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) _exit(127);
  ::setpgid(0, 0);
  const auto cpu = static_cast<rlim_t>(std::ceil(spec.cpu));
  limit(RLIMIT_CPU, cpu, cpu + 1);
  limit(RLIMIT_AS, static_cast<rlim_t>(spec.memory) << 20, static_cast<rlim_t>(spec.memory) << 20);
  const rlim_t file_size = rlim_t{1} << 30;  // bytes: keeps a planner that writes endlessly from filling the disk
  limit(RLIMIT_FSIZE, file_size, file_size);
  limit(RLIMIT_CORE, 0, 0);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(stream, STDOUT_FILENO);
  ::dup2(stream, STDERR_FILENO);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  ::execve(command[0], command, environment);
  _exit(127);
}

}  // namespace

Child::Child(const ChildSpec& spec)
    : mark_(new_mark()), wall_(spec.wall), cpu_(spec.cpu), begin_(std::chrono::steady_clock::now()) {
  std::vector<char*> command;
  for (const auto& word : spec.command) command.push_back(const_cast<char*>(word.c_str()));
  command.push_back(nullptr);
  std::vector<char*> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) environment.push_back(*entry);
  environment.push_back(mark_.data());
  environment.push_back(nullptr);
  int ends[2] = {-1, -1};
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  const pid_t parent = ::getpid();
  if (nothing >= 0 && ::pipe2(ends, O_CLOEXEC) == 0) pid_ = ::fork();
  if (pid_ == 0) become(command.data(), environment.data(), spec, parent, ends[1], nothing);
  const int problem = errno;
  if (nothing >= 0) ::close(nothing);
  if (ends[1] >= 0) ::close(ends[1]);
  if (pid_ < 0) {
    if (ends[0] >= 0) ::close(ends[0]);
    throw Error(fmt::format("cannot start {}: {}", spec.command.front(), std::generic_category().message(problem)));
  }
  ::setpgid(pid_, pid_);  // in both processes, since either may run first
  stream_ = ends[0];
  ::fcntl(stream_, F_SETFL, O_NONBLOCK);
}

Child::~Child() {
  if (!done_) {
    kill();
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    kill_marked(mark_);
  }
  if (stream_ >= 0) ::close(stream_);
}

void Child::kill() { ::kill(-pid_, SIGKILL); }

void Child::listen() {
  char buffer[4096];
  for (int i = 0; i < 64 && stream_ >= 0; ++i) {  // bounded: endless output must not defer the limits
    const ssize_t n = ::read(stream_, buffer, sizeof buffer);
    if (n > 0) {
      end_.last_words.append(buffer, static_cast<std::size_t>(n));
      const std::size_t most = 4096;  // bytes that a report shows
      if (end_.last_words.size() > most) end_.last_words.erase(0, end_.last_words.size() - most);
      continue;
    }
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
    ::close(stream_);
    stream_ = -1;
  }
}

bool Child::ended() {
  if (done_) return true;
  listen();
  int status = 0;
  rusage usage = {};
  const pid_t pid = ::wait4(pid_, &status, WNOHANG, &usage);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  if (pid != pid_) {
    if (wall > wall_ && !end_.out_of_wall) {
      end_.out_of_wall = true;
      kill();
    }
    return false;
  }
  done_ = true;
  kill();  // descendants that may still run
  kill_marked(mark_);
  listen();
  end_.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  end_.status = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  end_.wall_seconds = wall;
  end_.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  end_.peak_rss_mb = double(usage.ru_maxrss) / 1024;
  if (end_.signal == 0) end_.out_of_wall = false;  // it ended by itself just before it was killed
  end_.out_of_cpu =
      !end_.out_of_wall && (end_.signal == SIGXCPU || (end_.signal == SIGKILL && end_.cpu_seconds >= cpu_));
  return true;
}

}  // namespace dismantle::bench
