/// Output of a command: the streams, the amount of output, and the JSON line at the end.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "dismantle/run_context.h"
#include "progress.h"

namespace dismantle::app {

enum class Format { text, json };

/// The options --format, -q and -v.
struct ConsoleOptions {
  Format format = Format::text;
  bool quiet = false, verbose = false;
};
void add_format(CLI::App& command, ConsoleOptions& options);
void add_verbosity(CLI::App& command, ConsoleOptions& options);

/// With --format json, the last line of standard output is always one JSON object, and all other output goes to
/// standard error. See report_failure() for errors.
class Console {
 public:
  explicit Console(const ConsoleOptions& options);

  /// Shows the context's progress and log messages. The console must outlive the context.
  void attach(RunContext& context);
  /// Prints the result of the command in text form; nothing with -q.
  void text(std::string_view text);
  /// Prints a line about an event; nothing with -q.
  void line(std::string_view text);
  void warning(std::string_view text);
  void error(std::string_view text);
  /// The current phase and part.
  std::string busy_with() const;
  /// Prints `result` (with times and memory added) if the format is JSON.
  void result(nlohmann::ordered_json result);
  /// Clears the progress bar.
  void end_progress();

 private:
  void log(LogLevel level, std::string_view text);
  ConsoleOptions options_;
  std::unique_ptr<Progress> progress_;
};

/// `result` with "wall_seconds", "cpu_seconds" and "peak_rss_mb" of this process, as one line.
std::string result_line(nlohmann::ordered_json result);

}  // namespace dismantle::app
