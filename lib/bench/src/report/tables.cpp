#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "report/groups.h"
#include "report/more_tables.h"

namespace dismantle::bench {
namespace {

using Filter = std::function<bool(const ReportRow&)>;
using Columns = std::vector<std::pair<std::string, Filter>>;

TableCell success_cell(const Contender& c, const Filter& filter) {
  std::size_t n = 0, solved = 0;
  for (const ReportRow* row : c.rows) {
    if (!filter(*row)) continue;
    ++n;
    solved += row->solved ? 1 : 0;
  }
  if (n == 0) return {"-", std::nullopt};
  const Proportion p = wilson(solved, n);
  return {fmt::format("{:.1f} [{:.1f}, {:.1f}] {}/{}", 100 * p.share, 100 * p.low, 100 * p.high, solved, n),
          100 * p.share};
}

TableCell time_cell(const Contender& c, const Filter& filter) {
  std::size_t n = 0;
  double sum = 0;
  for (const ReportRow* row : c.rows) {
    if (!filter(*row) || !row->solved || row->removed.value_or(0) < 1) continue;
    ++n;
    sum += time_of(*row) / double(*row->removed);
  }
  if (n == 0) return {"-", std::nullopt};
  return {fmt::format("{:.3g} ({})", sum / double(n), n), sum / double(n)};
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

std::vector<Table> tables_of(const ReportData& data, const std::string& plans) {
  const auto contenders = contenders_of(data);
  std::vector<Table> out;
  out.push_back(table_by(contenders, by_category(data), success_cell));
  out.back().id = "success";
  out.back().title = "Success rate by category (%)";
  out.back().note =
      "Share of trials that were solved and whose plan the verifier accepts, 95 % interval of Wilson, solved/trials. "
      "Trials of "
      "one assembly with several seeds count one by one, so that the interval is too narrow where they do not differ.";
  out.push_back(table_by(contenders, by_size(data), success_cell));
  out.back().id = "sizes";
  out.back().title = "Success rate by number of parts (%)";
  out.back().note = "As above.";
  out.push_back(table_by(contenders, by_size(data), time_cell));
  out.back().id = "time";
  out.back().title = "Mean time per part (s)";
  out.back().note =
      "Solved trials only (their number in brackets): time from the preparation of the simulator to the end, divided "
      "by the "
      "number of parts that came out. Planners that solve more also solve harder ones: see the pairs for a fair "
      "comparison.";
  out.push_back(precision_table(contenders));
  out.push_back(pairs_table(contenders));
  out.push_back(outcomes_table(contenders));
  out.push_back(curves_table(data));
  out.push_back(trials_table(data, plans));
  return out;
}

}  // namespace dismantle::bench
