#include "report/groups.h"

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

void use_cpu_time(ReportData& data) {
  for (ReportRow& row : data.rows) {
    const bool stopped = row.outcome == "timeout" && row.limit_timeout > 0 && time_of(row) >= row.limit_timeout;
    row.limit_timeout = stopped ? row.cpu_seconds : 0;
    row.solve_seconds = row.cpu_seconds;
  }
  data.notes.push_back("Times are CPU seconds of the planning processes, reading the input included.");
}

}  // namespace dismantle::bench
