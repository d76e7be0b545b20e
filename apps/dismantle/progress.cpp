#include "dismantle/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace dismantle::app {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kRedraw{100}, kLine{1000};

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
  return out + fmt::format(" ({:.0f} s)", std::chrono::duration<double>(now - begin_).count());
}

void Progress::event(const ProgressEvent& event) {
  const std::lock_guard lock(mutex_);
  if (style_ == Style::none) return;
  const auto now = Clock::now();
  const bool fresh = event.phase != phase_;
  const bool changed = fresh || event.done != done_ || event.total != total_ || event.detail != detail_;
  if (fresh) begin_ = now;
  phase_ = event.phase;
  detail_ = event.detail;
  done_ = event.done;
  total_ = event.total;
  if (style_ == Style::bar) {
    if (fresh || now - drawn_ >= kRedraw) draw(now);
  } else if (changed && (fresh || now - drawn_ >= kLine)) {
    drawn_ = now;
    put(status(now) + "\n");
  }
}

void Progress::line(std::string_view text) {
  const std::lock_guard lock(mutex_);
  clear();
  put(fmt::format("{}\n", text));
}

void Progress::draw(Clock::time_point now) {
  constexpr std::size_t kBar = 24;
  drawn_ = now;
  std::string bar;
  if (total_ > 0) {
    const std::size_t full = kBar * std::min(done_, total_) / total_;
    bar = '[' + std::string(full, '#') + std::string(kBar - full, '.') + "] ";
  }
  put("\r" + cut(bar + status(now), columns() - 1) + "\x1b[K");
  visible_ = true;
}

void Progress::clear() {
  if (visible_) put("\r\x1b[K");
  visible_ = false;
}

/// Keeps the seconds running while a long attempt reports nothing.
void Progress::tick(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    wake_.wait_for(lock, stop, milliseconds(500), [] { return false; });
    if (!stop.stop_requested() && !phase_.empty() && Clock::now() - drawn_ >= kRedraw) draw(Clock::now());
  }
}

}  // namespace dismantle::app
