#include "interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string_view>

#include "command.h"

namespace dismantle::app {
namespace {

const CancelToken* g_token = nullptr;  // lives as long as the process
std::atomic<int> g_signals{0};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

// Uses only operations that are safe in a signal handler: lock-free atomics, write and _exit.
extern "C" void on_signal(int) {
  const int saved = errno;
  if (g_signals.fetch_add(1) > 0) _exit(kInterrupted);
  g_token->cancel();
  constexpr std::string_view text = "\nstopping: saving what is done (once more to stop now)\n";
  if (::write(STDERR_FILENO, text.data(), text.size()) < 0) {
    // Standard error is closed; the message cannot be shown.
  }
  errno = saved;
}

}  // namespace

void cancel_on_signals(const CancelToken& token) {
  g_token = new CancelToken(token);
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace dismantle::app
