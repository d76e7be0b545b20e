/// Tables and curves from databases of results.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/bench/statistics.h"
#include "dismantle/bench/suite.h"
#include "dismantle/bench/trial_row.h"
#include "dismantle/export.h"

namespace dismantle::bench {

/// All rows of any number of databases, each trial once. Their order does not depend on which database held them.
struct ReportData {
  std::string name;
  std::vector<std::string> planners, variants;  ///< in the order of the suite
  std::vector<ReportRow> rows;
  std::map<std::string, std::vector<PluginUse>> composition;  ///< of each planner
  std::vector<SuiteTable> tables;                             ///< of the suites
  std::size_t missing = 0;         ///< trials that are listed in the databases but not finished
  std::vector<std::string> notes;  ///< remarks that the report shows to its reader
};

/// `paths`: databases, or folders with databases. @throws InputError when there is none, one cannot be read, or two
/// hold different configurations under one name.
DISMANTLE_API ReportData read_results(const std::vector<std::filesystem::path>& paths);

/// The figures of a trial that have names of plugins: `counts.NAME` of what planners count, `checks.NAME` of what step
/// checks cost. Empty for a trial that ended before.
DISMANTLE_API std::map<std::string, double> named_figures(const ReportRow& row);

/// Replaces the wall times of planning in `data` by the CPU seconds of the planning processes, which include reading
/// the input. For trials that shared a busy machine with other work. A trial that `limits.timeout` stopped is censored
/// at the CPU time that it had used by then.
DISMANTLE_API void use_cpu_time(ReportData& data);

struct TableCell {
  std::string text;
  std::optional<double> value = {};  ///< sort key
  std::string link = {};             ///< for the HTML page, relative to it
};
struct Table {
  std::string id, title, note;
  std::vector<std::string> columns;
  std::vector<std::vector<TableCell>> rows;
  std::string remark{};  ///< what its author has to know: also in formats that leave notes out
};

/// The tables setup, planners, success, sizes, time, solution, plans, precision, pairs, outcomes, counts, those of the
/// suites, progress, searches, curves and trials. `links`: of
/// each row, to what shows its plan, relative to the page; empty: none.
DISMANTLE_API std::vector<Table> tables_of(const ReportData& data, const std::vector<std::string>& links = {});

/// Writes the plan of each row that has one as `folder`/ROW.json, rows counted from 1. Returns the link of each row,
/// relative to the parent of `folder`; empty: no plan.
DISMANTLE_API std::vector<std::string> write_plans(const ReportData& data, const std::filesystem::path& folder);

/// Share of trials solved within a time (1 - Kaplan-Meier): a step at each (seconds, share). A trial that ran out of
/// time is censored at that time; a trial that failed for another reason counts as never solved.
struct Curve {
  std::string label;
  SuccessSteps steps;  ///< increasing
  double end = 0;      ///< largest time observed of any planner, seconds; until then the curve keeps its last value
  std::size_t solved = 0, censored = 0, never = 0;
};
DISMANTLE_API std::vector<Curve> curves_of(const ReportData& data);
/// Mean share of the parts that are out after a time, of all trials; a trial that has ended keeps its last value.
DISMANTLE_API std::vector<Curve> progress_of(const ReportData& data);
/// Mean way of the best state of a search after some effort (SearchStats::cost), in largest edges of the assembly and
/// at most 1, of all searches that recorded their states. `end`: an effort.
DISMANTLE_API std::vector<Curve> searches_of(const ReportData& data);

DISMANTLE_API std::string report_text(const ReportData& data, const std::vector<Table>& tables);
DISMANTLE_API std::string report_markdown(const ReportData& data, const std::vector<Table>& tables);
/// CSV (RFC 4180); an empty line separates the tables.
DISMANTLE_API std::string report_csv(const std::vector<Table>& tables);
/// The curves as one picture.
DISMANTLE_API std::string report_svg(const ReportData& data);
/// One self-contained file.
DISMANTLE_API std::string report_html(const ReportData& data, const std::vector<Table>& tables);

/// Writes the five tables that OMPL's Planner Arena reads. Replaces `file`.
DISMANTLE_API void write_arena(const ReportData& data, const std::filesystem::path& file);

/// Writes the files for repeating and inspecting a row: `config.yaml`, `plan.json` (if it has one), `row.json`, and, if
/// the trial kept its search trees, `search_trees.json` and their pictures in `search_trees.html`. Returns the command
/// that repeats the trial.
DISMANTLE_API std::string write_row(const ReportRow& row, const std::filesystem::path& folder);

}  // namespace dismantle::bench
