#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "report/groups.h"
#include "report/more_tables.h"

namespace dismantle::bench {
namespace {

using Filter = std::function<bool(const ReportRow&)>;
using Columns = std::vector<std::pair<std::string, Filter>>;

TableCell success_cell(const Contender& c, const Filter& filter) {
  std::size_t n = 0, solved = 0;
  std::set<std::size_t> observations;
  for (const ReportRow* row : c.rows) {
    if (!filter(*row)) continue;
    ++n;
    solved += row->solved ? 1 : 0;
    observations.insert(row->observation);
  }
  if (n == 0) return {"-", std::nullopt};
  // Repetitions do not make the share more certain. n * (n / n) is n, so that the ends of the interval are exact.
  const double independent = double(observations.size());
  const Proportion p = wilson(independent * (double(solved) / double(n)), independent);
  return {fmt::format("{:.1f} [{:.1f}, {:.1f}] {}/{}{}", 100 * p.share, 100 * p.low, 100 * p.high, solved, n,
                      observations.size() < n ? fmt::format(", n = {}", observations.size()) : ""),
          100 * p.share};
}

/// Mean seconds per part of each assembly that a contender solved.
std::map<std::string, double> time_per_part(const Contender& c, const Filter& filter) {
  std::map<std::string, std::pair<double, double>> sums;
  for (const ReportRow* row : c.rows) {
    if (!filter(*row) || !row->solved || row->removed.value_or(0) < 1) continue;
    auto& [sum, n] = sums[row->assembly];
    sum += time_of(*row) / double(*row->removed);
    ++n;
  }
  std::map<std::string, double> out;
  for (const auto& [assembly, of] : sums) out[assembly] = of.first / of.second;
  return out;
}

/// Over the assemblies that all contenders of the variant solved, of those that solved any.
TableCell time_cell(const std::vector<Contender>& contenders, const Contender& c, const Filter& filter) {
  const auto own = time_per_part(c, filter);
  if (own.empty()) return {"-", std::nullopt};
  std::set<std::string> common;
  for (const auto& entry : own) common.insert(entry.first);
  for (const auto& other : contenders) {
    const auto times = other.variant == c.variant ? time_per_part(other, filter) : own;
    if (!times.empty()) std::erase_if(common, [&](const std::string& name) { return !times.contains(name); });
  }
  if (common.empty()) return {fmt::format("- (0 of {})", own.size()), std::nullopt};
  double sum = 0;
  for (const auto& name : common) sum += own.at(name);
  const double mean = sum / double(common.size());
  return {fmt::format("{:.3g} ({} of {})", mean, common.size(), own.size()), mean};
}

Table table_by(const std::vector<Contender>& contenders, const Columns& columns,
               const std::function<TableCell(const Contender&, const Filter&)>& cell) {
  Table table;
  table.columns = {"planner"};
  for (const auto& column : columns) table.columns.push_back(column.first);
  for (const auto& c : contenders) {
    std::vector<TableCell> row = {{c.label, std::nullopt}};
    for (const auto& column : columns) row.push_back(cell(c, column.second));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Columns by_category(const ReportData& data) {
  Columns columns;
  std::set<std::string> names;
  for (const auto& row : data.rows) names.insert(row.category);
  for (const auto& name : names)
    columns.emplace_back(name.empty() ? "other" : name, [name](const ReportRow& r) { return r.category == name; });
  columns.emplace_back("overall", [](const ReportRow&) { return true; });
  return columns;
}

Columns by_size(const ReportData& data) {
  struct SizeClass {
    const char* label;
    std::int64_t least, most;  // number of parts
  };
  const SizeClass sizes[] = {// size classes of the paper
                             {"two-part (2)", 2, 2},
                             {"small (3-9)", 3, 9},
                             {"medium (10-49)", 10, 49},
                             {"large (50+)", 50, INT64_MAX}};
  Columns columns;
  for (const auto& size : sizes) {
    const Filter filter = [size](const ReportRow& r) {
      return r.parts && *r.parts >= size.least && *r.parts <= size.most;
    };
    if (std::any_of(data.rows.begin(), data.rows.end(), filter)) columns.emplace_back(size.label, filter);
  }
  const Filter unknown = [](const ReportRow& r) { return !r.parts; };
  if (std::any_of(data.rows.begin(), data.rows.end(), unknown)) columns.emplace_back("unknown size", unknown);
  columns.emplace_back("overall", [](const ReportRow&) { return true; });
  return columns;
}

}  // namespace

std::vector<Table> tables_of(const ReportData& data, const std::vector<std::string>& links) {
  const auto contenders = contenders_of(data);
  std::vector<Table> out = {setup_table(data), planners_table(data)};
  out.push_back(table_by(contenders, by_category(data), success_cell));
  out.back().id = "success";
  out.back().title = "Success rate by category (%)";
  out.back().note =
      "Share of trials that were solved and whose plan the verifier accepts, 95 % interval of Wilson, solved/trials. "
      "Seeds of one assembly that were solved by the same steps, or were all not solved, are one observation: the "
      "interval is that of n observations.";
  out.push_back(table_by(contenders, by_size(data), success_cell));
  out.back().id = "sizes";
  out.back().title = "Success rate by number of parts (%)";
  out.back().note = "As above.";
  out.push_back(table_by(contenders, by_size(data),
                         [&](const Contender& c, const Filter& filter) { return time_cell(contenders, c, filter); }));
  out.back().id = "time";
  out.back().title = "Mean time per part (s)";
  out.back().note =
      "Over the assemblies that every planner solved, of those planners that solved any (their number, and how many "
      "this "
      "planner solved): time from the preparation of the simulator to the end, divided by the number of parts that "
      "came "
      "out; the mean over an assembly's solved trials, then over assemblies.";
  out.push_back(solution_table(data));
  out.push_back(plans_table(contenders));
  out.push_back(precision_table(contenders));
  out.push_back(pairs_table(contenders));
  out.push_back(outcomes_table(contenders));
  out.push_back(counts_table(contenders));
  for (const SuiteTable& table : data.tables) out.push_back(suite_table(table, contenders));
  out.push_back(progress_table(data));
  out.push_back(searches_table(data));
  out.push_back(curves_table(data));
  out.push_back(trials_table(data, links));
  return out;
}

}  // namespace dismantle::bench
