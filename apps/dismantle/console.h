/// How a command talks: what goes to which stream, how much of it, and the JSON line at the end.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "dismantle/progress.h"
#include "dismantle/run_context.h"

namespace dismantle::app {

enum class Format { text, json };

/// The options --format, -q and -v.
struct ConsoleOptions {
  Format format = Format::text;
  bool quiet = false, verbose = false;
};
void add_format(CLI::App& command, ConsoleOptions& options);
void add_verbosity(CLI::App& command, ConsoleOptions& options);

/// With --format json the standard output gets one JSON object as its last line, whatever happens, and all else
/// goes to standard error. See report_failure() for errors.
class Console {
 public:
  explicit Console(const ConsoleOptions& options);

  /// Sinks for progress and log messages. The console must outlive the context.
  void attach(RunContext& context);
  /// What the command has to say in text form; nothing with -q.
  void text(std::string_view text);
  /// A line about something that happened; nothing with -q.
  void line(std::string_view text);
  void warning(std::string_view text);
  void error(std::string_view text);
  /// What is going on: the phase and the part in hand.
  std::string busy_with() const;
  /// Prints `result` (with times and memory added) if the format is JSON.
  void result(nlohmann::ordered_json result);
  /// Takes the bar away.
  void end_progress();

 private:
  void log(LogLevel level, std::string_view text);
  ConsoleOptions options_;
  std::unique_ptr<Progress> progress_;
};

/// `result` with "wall_seconds", "cpu_seconds" and "peak_rss_mb" of this process, as one line.
std::string result_line(nlohmann::ordered_json result);

}  // namespace dismantle::app
