/// Progress on the standard error stream: a bar on a terminal, plain lines elsewhere. The remaining time is shown only
/// where it can be estimated: in phases whose items are alike. For the parts that are left it cannot; there the limit
/// is shown.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "dismantle/run_context.h"

namespace dismantle::app {

/// Safe to call from several threads.
class Progress {
 public:
  enum class Style { none, lines, bar };

  explicit Progress(Style style);
  ~Progress();  ///< clears the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// bar on a terminal that can move its cursor, else lines.
  static Style style_of_stderr();

  void event(const ProgressEvent& event);
  /// When the run ends at the latest; shown where nothing better is known.
  void ends_by(const Deadline& deadline);
  /// The phase and the part in hand: "parts out 3/9: shaft (12 s)".
  std::string busy_with();
  /// A line above the bar.
  void line(std::string_view text);

 private:
  using Clock = std::chrono::steady_clock;
  void draw(Clock::time_point now);
  void clear();
  void tick(std::stop_token stop);
  std::string status(Clock::time_point now) const;
  bool may_redraw(Clock::time_point now) const;

  const Style style_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::string phase_, detail_;
  std::size_t done_ = 0, total_ = 0;
  Clock::time_point begin_, drawn_;
  Deadline deadline_;
  bool visible_ = false;
  std::jthread ticker_;  // last: it stops before what it uses is gone
};

}  // namespace dismantle::app
