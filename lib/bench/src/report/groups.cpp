#include "report/groups.h"

#include <algorithm>

namespace dismantle::bench {

std::vector<Contender> contenders_of(const ReportData& data) {
  std::vector<Contender> out;
  for (const auto& variant : data.variants)
    for (const auto& planner : data.planners) {
      Contender c{planner, variant, data.variants.size() > 1 ? planner + " (" + variant + ")" : planner, {}};
      for (const auto& row : data.rows)
        if (row.planner == planner && row.variant == variant) c.rows.push_back(&row);
      if (!c.rows.empty()) out.push_back(std::move(c));
    }
  return out;
}

double time_of(const ReportRow& row) { return row.solve_seconds.value_or(row.wall_seconds); }

double observed_time(const ReportRow& row) {
  return row.stops_at > 0 ? std::min(time_of(row), row.stops_at) : time_of(row);
}

bool out_of_time(const ReportRow& row) {
  if (row.outcome == "wall_limit" || row.outcome == "cpu_limit") return true;
  return row.outcome == "timeout" && row.stops_at > 0 && time_of(row) >= row.stops_at;
}

void use_cpu_time(ReportData& data) {
  for (ReportRow& row : data.rows) {
    row.stops_at = row.outcome == "timeout" && out_of_time(row) ? row.cpu_seconds : 0;
    row.solve_seconds = row.cpu_seconds;
  }
  data.notes.push_back("Times are CPU seconds of the planning processes, reading the input included.");
}

}  // namespace dismantle::bench
