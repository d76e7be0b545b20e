#include "dismantle/isolation.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <new>
#include <system_error>

#include "dismantle/command.h"
#include "dismantle/errors.h"

namespace dismantle::app {
namespace {

std::atomic<int> g_told{0};  // number of signals that the parent received
extern "C" void on_told(int) { g_told.fetch_add(1); }

std::int64_t now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Does nothing in sanitizer builds, because sanitizers reserve terabytes of address space.
void limit_memory([[maybe_unused]] std::int64_t mib) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const rlimit limit = {static_cast<rlim_t>(mib) << 20, static_cast<rlim_t>(mib) << 20};
  if (::setrlimit(RLIMIT_AS, &limit) != 0)
    throw Error(fmt::format("memory cannot be limited to {} MiB: {}", mib, std::generic_category().message(errno)));
#endif
}

}  // namespace

Isolation::Isolation(std::int64_t memory) : memory_(memory) {
  if (memory_ <= 0)
    memory_ = static_cast<std::int64_t>(::sysconf(_SC_PHYS_PAGES)) * ::sysconf(_SC_PAGE_SIZE) / (std::int64_t{1} << 20);
  void* shared = ::mmap(nullptr, sizeof(RunNotes), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED)
    throw Error("no memory to share with a child process: " + std::generic_category().message(errno));
  notes_ = new (shared) RunNotes;
  const pid_t parent = ::getpid();
  child_ = ::fork();
  if (child_ < 0) throw Error("cannot start a child process: " + std::generic_category().message(errno));
  if (child_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(kPluginFailed);
    ::setpgid(0, 0);  // only the parent receives Ctrl-C and forwards it
    limit_memory(memory_);
    return;
  }
  ::setpgid(child_, child_);  // in both processes, since either may run first
  struct sigaction action = {};
  action.sa_handler = on_told;
  sigemptyset(&action.sa_mask);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

Isolation::~Isolation() {
  if (child_ <= 0) return;
  ::kill(-child_, SIGKILL);
  int status = 0;
  while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
}

IsolatedEnd Isolation::wait() {
  IsolatedEnd end;
  int passed_on = 0, status = 0;
  std::int64_t last_moment = 0;  // when to kill the child after Ctrl-C; 0: none
  // Extra time beyond the child's grace, ns, so that its own watchdog acts first: that one can save more.
  const std::int64_t margin = 5'000'000'000;
  std::string killed_for;
  while (true) {
    const pid_t pid = ::waitpid(child_, &status, WNOHANG);
    if (pid == child_) break;
    if (pid < 0 && errno != EINTR) throw Error("the child process is lost: " + std::generic_category().message(errno));
    const int told = g_told.load();
    const std::int64_t grace = notes_->grace.load(), limit = notes_->end.load();
    if (told > passed_on && passed_on == 0) {
      ::kill(child_, SIGINT);
      passed_on = 1;
      if (grace > 0) last_moment = now() + grace + margin;
    }
    if (killed_for.empty()) {
      if (told > 1) killed_for = "it was interrupted twice";
      if (limit > 0 && now() > limit + margin)
        killed_for = "its time was over (run.timeout, run.grace), and it did not stop";
      if (last_moment > 0 && now() > last_moment) killed_for = "it was interrupted, and did not stop (run.grace)";
      if (!killed_for.empty()) {
        end.interrupted = told > 1;
        ::kill(-child_, SIGKILL);
      }
    }
    ::poll(nullptr, 0, 20);
  }
  ::kill(-child_, SIGKILL);  // descendants that may still run
  child_ = -1;
  end.exited = WIFEXITED(status);
  if (end.exited) {
    end.status = WEXITSTATUS(status);
    return end;
  }
  const int signal = WTERMSIG(status);
  if (passed_on > 0 && signal == SIGINT) end.interrupted = true;  // the child had no handler yet
  std::string who = notes_->culprit.get();
  if (!killed_for.empty())
    end.why = fmt::format("the process of the run was killed: {}", killed_for);
  else if (!who.empty())
    end.why = who;
  else if (signal == SIGKILL)
    end.why = fmt::format(
        "the process of the run was killed from outside, as the system does where memory runs out (it may use {} MiB; "
        "--memory sets less)",
        memory_);
  else
    end.why = fmt::format("the process of the run crashed ({})", ::strsignal(signal));
  const char* busy = notes_->busy.get();
  const char* chosen = notes_->chosen.get();
  if (*busy != '\0') end.why += fmt::format(" at '{}'", busy);
  if (*chosen != '\0') end.why += fmt::format(", with {}", chosen);
  return end;
}

}  // namespace dismantle::app
