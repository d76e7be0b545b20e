/// From databases of results to tables and curves.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/export.h"

namespace dismantle::bench {

/// A trial that is done, as far as reports look at it. Times in seconds.
struct ReportRow {
  std::filesystem::path database;
  std::int64_t id = 0;  ///< in that database
  std::string assembly, variant, planner, category, part, outcome, planner_hash, config_hash, host, version, counts,
      input, last_words, verification;
  std::int64_t seed = 0, signal = 0;
  bool solved = false;
  std::optional<bool> verified;
  std::optional<double> max_penetration, solve_seconds;
  std::optional<std::int64_t> parts, removed;
  bool has_plan = false;
  double wall_seconds = 0, cpu_seconds = 0, peak_rss_mb = 0, limit_timeout = 0, limit_wall = 0;
  std::int64_t limit_memory_mb = 0;
  std::vector<std::pair<double, std::int64_t>> progress;  ///< seconds, parts out
};

/// All rows of any number of databases, each trial once, in an order that does not depend on how they were spread.
struct ReportData {
  std::string name;
  std::vector<std::string> planners, variants;  ///< in the order of the suite
  std::vector<ReportRow> rows;
  std::size_t missing = 0;         ///< trials that are listed in the databases and not done
  std::vector<std::string> notes;  ///< what a reader has to know
};

/// `paths`: databases, or folders with databases. @throws InputError: none there, not readable, or two of them hold
/// different configurations under one name.
DISMANTLE_API ReportData read_results(const std::vector<std::filesystem::path>& paths);

/// Times of `data` are CPU seconds of the planning processes from here on, reading the input included, in place of the wall time of
/// planning: for trials that ran beside other work on a busy machine. A trial that `limits.timeout` stopped is censored at the CPU
/// time that it had had by then.
DISMANTLE_API void use_cpu_time(ReportData& data);

struct TableCell {
  std::string text;
  std::optional<double> value = {};  ///< to sort by
  std::string link = {};             ///< of the HTML page, relative to it
};
struct Table {
  std::string id, title, note;
  std::vector<std::string> columns;
  std::vector<std::vector<TableCell>> rows;
};

/// success, sizes, time, precision, pairs, outcomes, curves, trials. `plans`: folder with the plans, relative to the page; empty:
/// none.
DISMANTLE_API std::vector<Table> tables_of(const ReportData& data, const std::string& plans = "");

/// Writes the plan of each row that has one as `folder`/ROW.json, rows counted from 1. Returns how many.
DISMANTLE_API std::size_t write_plans(const ReportData& data, const std::filesystem::path& folder);

/// Share of successes of `hits` in `n` with its 95 % interval of Wilson. n > 0.
struct Proportion {
  double share = 0, low = 0, high = 0;
};
DISMANTLE_API Proportion wilson(std::size_t hits, std::size_t n);

/// Share of trials solved after a time: a step at each (seconds, share). A trial that ran out of time is censored
/// there; one that failed for another reason is never solved (1 - Kaplan-Meier).
struct Curve {
  std::string label;
  std::vector<std::pair<double, double>> steps;  ///< increasing
  double end = 0;                                ///< largest time observed, seconds
};
/// Events: seconds, and solved or censored at that time. `never`: trials that failed for good.
DISMANTLE_API std::vector<std::pair<double, double>> success_over_time(std::vector<std::pair<double, bool>> events,
                                                                       std::size_t never);
DISMANTLE_API std::vector<Curve> curves_of(const ReportData& data);

DISMANTLE_API std::string report_text(const ReportData& data, const std::vector<Table>& tables);
DISMANTLE_API std::string report_markdown(const ReportData& data, const std::vector<Table>& tables);
/// One table after the other, with an empty line between; RFC 4180.
DISMANTLE_API std::string report_csv(const std::vector<Table>& tables);
/// The curves as one picture.
DISMANTLE_API std::string report_svg(const ReportData& data);
/// One file that needs nothing else.
DISMANTLE_API std::string report_html(const ReportData& data, const std::vector<Table>& tables);

/// The five tables that OMPL's Planner Arena opens. Replaces `file`.
DISMANTLE_API void write_arena(const ReportData& data, const std::filesystem::path& file);

/// Writes what is needed to repeat and look at a row: `config.yaml`, `plan.json` (if it has one), `row.json`. Returns
/// the command that runs it again.
DISMANTLE_API std::string write_row(const ReportRow& row, const std::filesystem::path& folder);

}  // namespace dismantle::bench
