#include "child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <utility>

namespace dismantle::reader_process {
namespace {

bool can_limit_memory() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;  // the shadow memory of a sanitizer needs terabytes of address space
#else
  return true;
#endif
}

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() { close(); }
  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  int get() const { return fd_; }

 private:
  int fd_ = -1;
};

struct Pipe {
  Descriptor read, write;
  bool open() {
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) return false;
    read = Descriptor(ends[0]);
    write = Descriptor(ends[1]);
    return true;
  }
};

/// Kills and reaps the child in every case.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (id_ > 0) {
      kill();
      wait();
    }
  }
  void kill() const { ::kill(-id_, SIGKILL); }
  /// True if it has ended; then `status` is set.
  bool ended(int& status) {
    if (::waitpid(id_, &status, WNOHANG) != id_) return false;
    id_ = -1;
    return true;
  }
  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

 private:
  pid_t id_;
};

/// Runs in the child between fork and exec: only async-signal-safe calls, because the host has other threads.
[[noreturn]] void become(char* const* arguments, const ChildLimits& limits, int output, int messages, int failure) {
  const auto give_up = [&] {
    const int error = errno;
    (void)!::write(failure, &error, sizeof error);
    ::_exit(127);
  };
  ::setpgid(0, 0);  // Ctrl-C then reaches only the host, which decides
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const auto limit = [](__rlimit_resource what, rlim_t soft, rlim_t hard) {
    rlimit now = {};
    if (::getrlimit(what, &now) != 0) return false;
    const rlimit both = {std::min(soft, now.rlim_max), std::min(hard, now.rlim_max)};
    return ::setrlimit(what, &both) == 0;
  };
  limit(RLIMIT_CORE, 0, 0);
  if (can_limit_memory() && limits.memory > 0 && !limit(RLIMIT_AS, limits.memory, limits.memory)) give_up();
  const auto seconds = static_cast<rlim_t>(std::ceil(limits.seconds)) + 1;
  if (limits.seconds > 0 && !limit(RLIMIT_CPU, seconds, seconds + 1)) give_up();  // SIGXCPU at the soft limit
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  const int input = ::open("/dev/null", O_RDONLY);
  if (input < 0 || ::dup2(input, STDIN_FILENO) < 0) give_up();
  // `output` and `messages` are above 2, see run_child.
  if (::dup2(output, STDOUT_FILENO) < 0 || ::dup2(messages, STDERR_FILENO) < 0) give_up();
  ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  ::execv(arguments[0], arguments);
  give_up();
  ::_exit(127);
}

/// Moves a descriptor above those of the standard streams, which the host may have closed.
bool lift(Descriptor& descriptor) {
  const int lifted = ::fcntl(descriptor.get(), F_DUPFD_CLOEXEC, 3);
  if (lifted < 0) return false;
  descriptor = Descriptor(lifted);
  return true;
}

/// Reads once. Returns false at the end.
template <class Take>
bool drain(Descriptor& from, Take take) {
  std::array<std::byte, 1 << 16> buffer;
  const ssize_t n = ::read(from.get(), buffer.data(), buffer.size());
  if (n < 0 && (errno == EINTR || errno == EAGAIN)) return true;
  if (n <= 0) {
    from.close();
    return false;
  }
  take(std::span<const std::byte>(buffer.data(), static_cast<std::size_t>(n)));
  return true;
}

}  // namespace

ChildEnd run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   const ChildLimits& limits, const std::function<bool()>& should_stop,
                   const std::function<bool(std::span<const std::byte>)>& take) {
  using Clock = std::chrono::steady_clock;
  ChildEnd end;
  Pipe output, messages, failure;
  if (!output.open() || !messages.open() || !failure.open() || !lift(output.write) || !lift(messages.write) ||
      !lift(failure.write)) {
    end.code = errno;
    return end;
  }
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t id = ::fork();
  if (id < 0) {
    end.code = errno;
    return end;
  }
  if (id == 0) become(argv.data(), limits, output.write.get(), messages.write.get(), failure.write.get());
  ::setpgid(id, id);  // in both processes, since either may run first
  Child child(id);
  output.write.close();
  messages.write.close();
  failure.write.close();
  int error = 0;
  ssize_t n = 0;
  while ((n = ::read(failure.read.get(), &error, sizeof error)) < 0 && errno == EINTR) {
  }
  if (n == sizeof error) {
    end.code = error;
    return end;
  }

  const auto begin = Clock::now();
  bool killed = false;
  const auto stop = [&](ChildEnd::How how) {
    end.how = how;
    killed = true;
    child.kill();
  };
  int status = 0;
  bool ended = false;
  while (!killed && !ended) {
    // Read the streams to their end first: a child that has ended may have left data in them.
    if (output.read.get() < 0 && messages.read.get() < 0 && child.ended(status)) {
      ended = true;
      break;
    }
    pollfd polled[2] = {{output.read.get(), POLLIN, 0}, {messages.read.get(), POLLIN, 0}};
    ::poll(polled, 2, output.read.get() < 0 && messages.read.get() < 0 ? 1 : 50);
    bool accepted = true;
    if (polled[0].revents != 0) drain(output.read, [&](auto bytes) { accepted = take(bytes); });
    if (polled[1].revents != 0)
      drain(messages.read, [&](auto bytes) {
        end.messages.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        const std::size_t kept = 4096;  // the last bytes
        if (end.messages.size() > 2 * kept) end.messages.erase(0, end.messages.size() - kept);
      });
    if (!accepted || should_stop())
      stop(ChildEnd::How::stopped);
    else if (limits.seconds > 0 && std::chrono::duration<double>(Clock::now() - begin).count() > limits.seconds)
      stop(ChildEnd::How::timed_out);
  }
  if (killed) return end;
  if (WIFEXITED(status)) {
    end.how = ChildEnd::How::exited;
    end.code = WEXITSTATUS(status);
  } else {
    end.code = WTERMSIG(status);
    end.how = end.code == SIGXCPU ? ChildEnd::How::timed_out : ChildEnd::How::crashed;
  }
  return end;
}

}  // namespace dismantle::reader_process
