#include "report/stored_plans.h"

#include <fmt/format.h>

#include "dismantle/errors.h"
#include "store/compress.h"

namespace dismantle::bench {

std::string StoredPlans::of(const ReportRow& row) {
  auto& db = open_[row.database];
  if (!db) db = std::make_unique<Sqlite>(row.database, Sqlite::Mode::read);
  auto plan = db->prepare("SELECT size, bytes FROM plans WHERE trial = ?");
  plan.bind(row.id);
  if (!plan.step()) throw InputError(db->name(), fmt::format("the plan of row {} is gone", row.id));
  return expanded(plan.text(1), static_cast<std::size_t>(plan.integer(0)));
}

}  // namespace dismantle::bench
