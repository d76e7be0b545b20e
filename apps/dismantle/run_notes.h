/// What is known of a run when its process is about to die: plain text of fixed size, which a signal handler may read,
/// and which may lie in memory that two processes share.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace dismantle::app {

/// Text that one thread writes at a time and any may read: a reader sees the old text or the new one.
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
  NoteText<512> busy;                ///< the phase and the part in hand
  NoteText<512> chosen;              ///< simulator and planners
  NoteText<1024> plan;               ///< plan.json; empty: nothing has been saved yet
  NoteText<2048> culprit;            ///< of a crash: the signal, and the plugin that was found on the stack
  std::atomic<std::int64_t> end{0};  ///< of the run, ns of the steady clock, time for plugins to stop included; 0: none
  std::atomic<std::int64_t> grace{0};  ///< ns that plugins have to stop when they are told to; 0: as long as they like
};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

}  // namespace dismantle::app
