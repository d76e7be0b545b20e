#include "store/suite_tables.h"

#include <nlohmann/json.hpp>

namespace dismantle::bench {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SuiteTable, id, title, note, columns, all_trials)

std::string text_of(const std::vector<SuiteTable>& tables) { return nlohmann::json(tables).dump(); }

std::vector<SuiteTable> suite_tables_of(const std::string& text) {
  if (text.empty()) return {};
  return nlohmann::json::parse(text).get<std::vector<SuiteTable>>();
}

}  // namespace dismantle::bench
