// What trials and searches had reached before their end.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "report/cells.h"
#include "report/more_tables.h"

namespace dismantle::bench {
namespace {

/// One trial or search: (time or effort, value reached), increasing.
using Climb = std::vector<std::pair<double, double>>;

/// The mean of the climbs, each of which keeps its last value, as steps.
SuccessSteps mean_of(const std::vector<Climb>& climbs) {
  std::map<double, double> gains;
  for (const Climb& climb : climbs) {
    double before = 0;
    for (const auto& [at, value] : climb)
      if (value > before) gains[at] += value - before, before = value;
  }
  SuccessSteps out;
  double sum = 0;
  for (const auto& [at, gain] : gains) out.emplace_back(at, (sum += gain) / static_cast<double>(climbs.size()));
  return out;
}

std::vector<Curve> curves_of(const ReportData& data,
                             const std::function<std::vector<Climb>(const ReportRow&)>& climbs_of) {
  std::vector<Curve> out;
  double end = 0;
  for (const Contender& c : contenders_of(data)) {
    std::vector<Climb> climbs;
    for (const ReportRow* row : c.rows)
      for (Climb& climb : climbs_of(*row)) climbs.push_back(std::move(climb));
    if (climbs.empty()) continue;
    Curve curve;
    curve.label = c.label;
    curve.solved = climbs.size();
    curve.steps = mean_of(climbs);
    if (!curve.steps.empty()) end = std::max(end, curve.steps.back().first);
    out.push_back(std::move(curve));
  }
  for (Curve& curve : out) curve.end = end;
  return out;
}

/// The curves at a few round values.
Table table_of(const std::vector<Curve>& curves, const char* unit, const char* what) {
  Table table;
  table.columns = {"planner", what};
  std::vector<double> at;
  if (!curves.empty())
    for (double power = 0.1; power <= curves.front().end; power *= 10) at.push_back(power);
  if (!curves.empty()) at.push_back(curves.front().end);
  for (const double x : at) table.columns.push_back(fmt::format("{:.3g}{}", x, unit));
  for (const Curve& curve : curves) {
    std::vector<TableCell> row = {text(curve.label), whole(curve.solved)};
    for (const double x : at) {
      double value = 0;
      for (const auto& [from, reached] : curve.steps)
        if (from <= x) value = reached;
      row.push_back(number(100 * value, "{:.1f}"));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

std::vector<Curve> progress_of(const ReportData& data) {
  return curves_of(data, [](const ReportRow& row) {
    Climb climb;
    const double most =
        row.parts ? static_cast<double>(std::max<std::int64_t>(1, row.part.empty() ? *row.parts - 1 : 1)) : 1;
    for (const auto& [seconds, removed] : row.progress)
      climb.emplace_back(seconds, std::min(1.0, static_cast<double>(removed) / most));
    return std::vector<Climb>{climb};
  });
}

std::vector<Curve> searches_of(const ReportData& data) {
  return curves_of(data, [](const ReportRow& row) {
    std::map<std::int64_t, Climb> climbs;
    for (const SearchPoint& p : row.searches) climbs[p.search].emplace_back(p.effort, std::min(1.0, p.best));
    std::vector<Climb> out;
    for (auto& [search, climb] : climbs) out.push_back(std::move(climb));
    return out;
  });
}

Table progress_table(const ReportData& data) {
  Table table = table_of(progress_of(data), " s", "trials");
  table.id = "progress";
  table.title = "Parts out after a time (%)";
  table.note =
      "The mean share of the parts that are out, over all trials, whether they were solved or not. Seconds of "
      "planning, from "
      "the first search on. A trial that has ended keeps its last value.";
  return table;
}

Table searches_table(const ReportData& data) {
  Table table = table_of(searches_of(data), "", "searches");
  table.id = "searches";
  table.title = "Best state of a search after some effort (%)";
  table.note =
      "How far the best state is from where the part was, in largest edges of the assembly and at most 100 %: the mean "
      "over "
      "all searches for a path that had one. Effort is what the planner counts as its cost: simulated steps and state "
      "checks. "
      "Planners that record their searches only (docs/write-a-planner.md).";
  return table;
}

}  // namespace dismantle::bench
