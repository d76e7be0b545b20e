/// Plans as they are stored in databases of results.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "dismantle/bench/report.h"
#include "store/sqlite.h"

namespace dismantle::bench {

class StoredPlans {
 public:
  /// The text of the plan of a row that has one. @throws InputError when it is gone.
  std::string of(const ReportRow& row);

 private:
  std::map<std::filesystem::path, std::unique_ptr<Sqlite>> open_;
};

}  // namespace dismantle::bench
