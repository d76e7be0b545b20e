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

}  // namespace dismantle::bench
