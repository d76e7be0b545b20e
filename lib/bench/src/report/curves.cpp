#include <fmt/format.h>

#include <algorithm>

#include "report/cells.h"
#include "report/more_tables.h"

namespace dismantle::bench {
namespace {

/// 1, 2, 5, 10, ... up to the longest time.
std::vector<double> round_times(double end) {
  std::vector<double> out;
  for (double power = 0.1; power < 1e7; power *= 10)
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double t = power * digit;
      if (t > end) return out;
      out.push_back(t);
    }
  return out;
}

}  // namespace

std::vector<Curve> curves_of(const ReportData& data) {
  std::vector<Curve> out;
  double end = 0;
  for (const auto& c : contenders_of(data)) {
    Curve curve;
    curve.label = c.label;
    std::vector<std::pair<double, bool>> events;
    for (const ReportRow* row : c.rows) {
      // Planners stop slightly after the limit. Trials that are solved or fail in that interval count at the limit, so
      // that they do not come after the trials that were stopped.
      const double time = observed_time(*row);
      end = std::max(end, time);
      const bool censored = !row->solved && out_of_time(*row);
      if (row->solved || censored) events.emplace_back(time, row->solved);
      ++(row->solved ? curve.solved : censored ? curve.censored : curve.never);
    }
    curve.steps = success_over_time(std::move(events), curve.never);
    out.push_back(std::move(curve));
  }
  for (auto& curve : out) curve.end = end;
  return out;
}

Table curves_table(const ReportData& data) {
  const auto curves = curves_of(data);
  Table table;
  table.id = "curves";
  table.title = "Solved within a time (%)";
  table.note =
      "Seconds of planning. A trial that its time limit ended is censored there (1 - Kaplan-Meier); one that gave up, "
      "or whose attempts ran out of time before, counts as never solved. After its last solution a planner keeps its value.";
  table.columns = {"planner"};
  const auto times = round_times(curves.empty() ? 0 : curves.front().end);
  for (const double t : times) table.columns.push_back(fmt::format("{:g} s", t));
  for (const auto& curve : curves) {
    std::vector<TableCell> row = {text(curve.label)};
    for (const double t : times) {
      double share = 0;
      for (const auto& [at, value] : curve.steps)
        if (at <= t) share = value;
      row.push_back(number(100 * share, "{:.1f}"));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table solution_table(const ReportData& data) {
  const auto curves = curves_of(data);
  const double end = curves.empty() ? 0 : curves.front().end;
  Table table;
  table.id = "solution";
  table.title = "Time to solution (s)";
  table.note = fmt::format(
      "Of all trials. A trial that its time limit ended is censored there; one that ended otherwise without a solution is "
      "never solved. Times within which a quarter, half and three quarters of the trials are solved, by Kaplan-Meier; '-': "
      "fewer are. 'mean up to {0:.3g} s': a trial that is not solved until then, the longest time observed, counts with it.",
      end);
  table.columns = {"planner", "trials", "solved", "censored", "never", "25 %", "50 %", "75 %", fmt::format("mean up to {:.3g} s", end)};
  for (const auto& curve : curves) {
    std::vector<TableCell> row = {text(curve.label), whole(curve.solved + curve.censored + curve.never), whole(curve.solved),
                                  whole(curve.censored), whole(curve.never)};
    for (const double share : {0.25, 0.5, 0.75}) {
      const auto time = time_to(curve.steps, share);
      row.push_back(time ? number(*time) : text("-"));
    }
    row.push_back(number(restricted_mean(curve.steps, end)));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace dismantle::bench
