#include "isolation.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <new>
#include <system_error>

#include "command.h"
#include "dismantle/errors.h"

namespace dismantle::app {
namespace {

std::atomic<int> g_told{0};  // number of signals that the parent received
extern "C" void on_told(int) { g_told.fetch_add(1); }

std::int64_t now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

Isolation::Isolation(std::int64_t memory) : memory_(memory) {
  if (memory_ <= 0)
    memory_ = static_cast<std::int64_t>(::sysconf(_SC_PHYS_PAGES)) * ::sysconf(_SC_PAGE_SIZE) / (std::int64_t{1} << 20);
  void* shared = ::mmap(nullptr, sizeof(RunNotes), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED)
    throw Error("no memory to share with a child process: " + std::generic_category().message(errno));
  notes_ = new (shared) RunNotes;
  child_.emplace(process::Limits{.memory = static_cast<std::uint64_t>(memory_) << 20});
  if (in_child()) return;
  struct sigaction action = {};
  action.sa_handler = on_told;
  sigemptyset(&action.sa_mask);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

IsolatedEnd Isolation::wait() {
  IsolatedEnd end;
  int passed_on = 0;
  std::int64_t last_moment = 0;  // when to kill the child after Ctrl-C; 0: none
  // Extra time beyond the child's grace, ns, so that its own watchdog acts first: that one can save more.
  const std::int64_t margin = 5'000'000'000;
  std::string killed_for;
  while (!child_->ended()) {
    const int told = g_told.load();
    const std::int64_t grace = notes_->grace.load(), limit = notes_->end.load();
    if (told > passed_on && passed_on == 0) {
      child_->signal(SIGINT);
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
        child_->kill();
      }
    }
    ::poll(nullptr, 0, 20);
  }
  const int signal = child_->end().signal;
  end.exited = signal == 0;
  if (end.exited) {
    end.status = child_->end().status;
    return end;
  }
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
