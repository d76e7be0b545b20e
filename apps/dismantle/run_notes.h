/// Notes about a run for use when its process crashes: plain text of fixed size, which a signal handler may read and
/// which may be in memory that two processes share.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace dismantle::app {

/// Text that one thread at a time may write and any thread may read. A reader sees the old text or the new one.
template <std::size_t N>
class NoteText {
 public:
  void set(std::string_view text) {
    const int next = 1 - now_.load(std::memory_order_acquire);
    const std::size_t size = std::min(text.size(), N - 1);
    std::memcpy(text_[next], text.data(), size);
    text_[next][size] = '\0';
    now_.store(next, std::memory_order_release);
  }
  const char* get() const { return text_[now_.load(std::memory_order_acquire) & 1]; }

 private:
  std::atomic<int> now_{0};
  char text_[2][N] = {};
};

struct RunNotes {
  NoteText<512> busy;                  ///< the current phase and part
  NoteText<512> chosen;                ///< simulator and planners
  NoteText<1024> plan;                 ///< plan.json; empty: nothing has been saved yet
  NoteText<2048> culprit;              ///< after a crash: the signal and the plugin that was found on the stack
  std::atomic<std::int64_t> end{0};    ///< deadline of the run plus grace, ns of the steady clock; 0: none
  std::atomic<std::int64_t> grace{0};  ///< ns that plugins may take to stop after a request; 0: unlimited
};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

}  // namespace dismantle::app
