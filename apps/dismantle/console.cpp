#include "console.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "colour.h"

namespace dismantle::app {
namespace {

const auto g_begin = std::chrono::steady_clock::now();  // when the program was loaded

double seconds(const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); }
/// Rounds to a multiple of 1 / `steps`.
double rounded(double x, double steps) { return std::round(x * steps) / steps; }

}  // namespace

void add_format(CLI::App& command, ConsoleOptions& options) {
  command.add_option("--format", options.format, "text, or json: one JSON object as the last line of standard output")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Format>{{"text", Format::text}, {"json", Format::json}})
                      .description(""))
      ->option_text("text|json");
}

void add_verbosity(CLI::App& command, ConsoleOptions& options) {
  auto* quiet = command.add_flag("-q,--quiet", options.quiet, "Print errors only")->option_text(" ");
  command.add_flag("-v,--verbose", options.verbose, "Print more")->option_text(" ")->excludes(quiet);
}

Console::Console(const ConsoleOptions& options)
    : options_(options),
      progress_(std::make_unique<Progress>(options.quiet ? Progress::Style::none : Progress::style_of_stderr())) {}

void Console::attach(RunContext& context) {
  context.on_progress = [this](const ProgressEvent& event) { progress_->event(event); };
  progress_->ends_by(context.deadline);
  context.on_log = [this](LogLevel level, std::string_view text) { log(level, text); };
}

void Console::log(LogLevel level, std::string_view text) {
  const LogLevel least = options_.quiet ? LogLevel::error : options_.verbose ? LogLevel::debug : LogLevel::info;
  if (level < least) return;
  const std::string prefix = level == LogLevel::error     ? coloured(stderr, Colour::red, "error:") + " "
                             : level == LogLevel::warning ? coloured(stderr, Colour::yellow, "warning:") + " "
                                                          : "";
  progress_->line(fmt::format("{}{}", prefix, text));
}

void Console::line(std::string_view text) { log(LogLevel::info, text); }
void Console::warning(std::string_view text) { log(LogLevel::warning, text); }
void Console::error(std::string_view text) { log(LogLevel::error, text); }
std::string Console::busy_with() const { return progress_->busy_with(); }
void Console::end_progress() { progress_ = std::make_unique<Progress>(Progress::Style::none); }

void Console::text(std::string_view text) {
  if (options_.quiet) return;
  progress_->hide();
  std::FILE* stream = options_.format == Format::json ? stderr : stdout;
  std::fwrite(text.data(), 1, text.size(), stream);
  std::fflush(stream);
}

void Console::result(nlohmann::ordered_json result) {
  if (options_.format != Format::json) return;
  const std::string line = result_line(std::move(result));
  std::fwrite(line.data(), 1, line.size(), stdout);
  std::fflush(stdout);
}

std::string result_line(nlohmann::ordered_json result) {
  rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - g_begin).count();
  const auto plan = result.contains("plan") ? result["plan"] : nlohmann::ordered_json(nullptr);
  result.erase("plan");
  result["wall_seconds"] = rounded(wall, 1000);
  result["cpu_seconds"] = rounded(seconds(usage.ru_utime) + seconds(usage.ru_stime), 1000);
  result["peak_rss_mb"] = rounded(double(usage.ru_maxrss) / 1024, 10);
  result["plan"] = plan;
  return result.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace dismantle::app
