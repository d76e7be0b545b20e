#include "progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "colour.h"

namespace dismantle::app {
namespace {

using std::chrono::milliseconds;

std::size_t columns() {
  winsize size = {};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 10 ? size.ws_col : 80;
}

/// The first `width` characters of UTF-8 text.
std::string cut(const std::string& text, std::size_t width) {
  std::size_t end = 0;
  for (std::size_t n = 0; end < text.size(); ++end)
    if ((text[end] & 0xC0) != 0x80 && n++ == width) break;
  return text.substr(0, end);
}

void put(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

/// True if the items of the phase take similar times, so that the remaining time can be estimated.
bool is_even(std::string_view phase) {
  return phase == "read" || phase == "prepare" || phase == "hulls" || phase == "subdivide" || phase == "overlaps" ||
         phase == "fields" || phase == "verify";
}

std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  const auto minutes = static_cast<long>(seconds / 60 + 0.5);
  return minutes < 100 ? fmt::format("{} min", minutes) : fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

const char* words_of(std::string_view phase) {
  if (phase == "read") return "reading";
  if (phase == "prepare") return "preparing";
  if (phase == "fields") return "distance fields";
  if (phase == "sequence") return "parts out";
  if (phase == "verify") return "verifying";
  return nullptr;
}

}  // namespace

Progress::Progress(Style style) : style_(style), begin_(Clock::now()), drawn_(begin_) {
  if (style_ == Style::bar) ticker_ = std::jthread([this](std::stop_token stop) { tick(std::move(stop)); });
}

Progress::~Progress() {
  ticker_.request_stop();
  const std::lock_guard lock(mutex_);
  clear();
}

Progress::Style Progress::style_of_stderr() {
  const char* terminal = std::getenv("TERM");
  const bool dumb = terminal == nullptr || std::string_view(terminal) == "dumb";
  return ::isatty(STDERR_FILENO) == 1 && !dumb ? Style::bar : Style::lines;
}

std::string Progress::status(Clock::time_point now) const {
  const char* words = words_of(phase_);
  std::string out = words != nullptr ? words : phase_;
  if (total_ > 0) out += fmt::format(" {}/{}", done_, total_);
  if (!detail_.empty()) out += ": " + detail_;
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  out += " (" + duration(elapsed);
  const bool is_long = elapsed >= 5;  // s; shorter phases need no estimate
  // An estimate needs at least three items and a tenth of all items.
  if (is_long && is_even(phase_) && done_ >= 3 && 10 * done_ >= total_ && done_ < total_)
    out += fmt::format(", about {} left", duration(elapsed * double(total_ - done_) / double(done_)));
  else if (is_long && phase_ == "sequence" && std::isfinite(deadline_.seconds_left()))
    out += fmt::format(", ends within {}", duration(std::max(0.0, deadline_.seconds_left())));
  return out + ")";
}

bool Progress::may_redraw(Clock::time_point now) const { return now - drawn_ >= milliseconds(100); }

void Progress::event(const ProgressEvent& event) {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  const bool fresh = event.phase != phase_;
  const bool changed = fresh || event.done != done_ || event.total != total_ || event.detail != detail_;
  if (fresh) begin_ = now;
  phase_ = event.phase;
  detail_ = event.detail;
  done_ = event.done;
  total_ = event.total;
  if (style_ == Style::none) return;
  // Long runs report progress less often; each step that is found gets a separate line.
  using std::chrono::seconds;
  const auto pause = std::clamp<Clock::duration>((now - begin_) / 20, seconds(1), seconds(30));
  if (style_ == Style::bar) {
    if (fresh || may_redraw(now)) draw(now);
  } else if (changed && (fresh || now - drawn_ >= pause)) {
    drawn_ = now;
    put(status(now) + "\n");
  }
}

void Progress::ends_by(const Deadline& deadline) {
  const std::lock_guard lock(mutex_);
  deadline_ = deadline;
}

std::string Progress::busy_with() {
  const std::lock_guard lock(mutex_);
  return phase_.empty() ? "the beginning" : status(Clock::now());
}

void Progress::line(std::string_view text) {
  const std::lock_guard lock(mutex_);
  clear();
  put(fmt::format("{}\n", text));
}

void Progress::hide() {
  const std::lock_guard lock(mutex_);
  clear();
}

void Progress::draw(Clock::time_point now) {
  const std::size_t cells = 24;  // of the bar
  drawn_ = now;
  std::string bar;
  if (total_ > 0) {
    const std::size_t full = cells * std::min(done_, total_) / total_;
    bar = '[' + std::string(full, '#') + std::string(cells - full, '.') + "] ";
  }
  const std::string text = cut(bar + status(now), columns() - 1);
  const std::size_t painted = std::min(bar.size(), text.size());
  put("\r" + coloured(stderr, Colour::green, text.substr(0, painted)) + text.substr(painted) + "\x1b[K");
  visible_ = true;
}

void Progress::clear() {
  if (visible_) put("\r\x1b[K");
  visible_ = false;
}

/// Updates the displayed seconds while a long attempt reports nothing.
void Progress::tick(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    wake_.wait_for(lock, stop, milliseconds(500), [] { return false; });
    if (!stop.stop_requested() && !phase_.empty() && may_redraw(Clock::now())) draw(Clock::now());
  }
}

}  // namespace dismantle::app
