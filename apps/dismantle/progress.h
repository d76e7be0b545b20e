/// Progress on the standard error stream: a bar on a terminal, plain lines elsewhere. The remaining time is shown in
/// phases whose items take similar times. It cannot be estimated for the removal of parts; the time limit is shown
/// instead.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "dismantle/run_context.h"

namespace dismantle::app {

/// Thread-safe.
class Progress {
 public:
  enum class Style { none, lines, bar };

  explicit Progress(Style style);
  ~Progress();  ///< clears the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Style::bar on a terminal that can move its cursor, else Style::lines.
  static Style style_of_stderr();

  void event(const ProgressEvent& event);
  /// Sets the time limit of the run; shown where no estimate is available.
  void ends_by(const Deadline& deadline);
  /// The current phase and part: "parts out 3/9: shaft (12 s)".
  std::string busy_with();
  /// Prints a line above the bar.
  void line(std::string_view text);
  /// Clears the bar until the next event, for output that is not a line().
  void hide();

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
  std::jthread ticker_;  // last member: it stops before the members that it uses are destroyed
};

}  // namespace dismantle::app
