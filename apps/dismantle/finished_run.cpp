#include "finished_run.h"

#include <algorithm>
#include <sstream>

#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/read_file.h"
#include "dismantle/plan_io/write_file.h"

namespace dismantle::app {
namespace {

namespace fs = std::filesystem;

/// A resolved configuration without `threads`.
std::string settings_in(const std::string& resolved) {
  std::istringstream in(resolved);
  std::string out;
  for (std::string line; std::getline(in, line);)
    if (line.substr(std::min(line.size(), line.find_first_not_of(' '))).rfind("threads:", 0) != 0) out += line + "\n";
  return out;
}

}  // namespace

void write_finished(const fs::path& folder, int status, const nlohmann::ordered_json& result) {
  nlohmann::ordered_json record = nlohmann::ordered_json::parse(result_line(result));
  record["exit_status"] = status;
  write_file(folder / kFinishedRun, record.dump(2) + "\n");
}

std::optional<FinishedRun> finished_run(const fs::path& folder, const std::string& input, const Session& session,
                                        const RunContext& context) {
  std::error_code none;
  for (const char* name : {kFinishedRun, "plan.json", "resolved.yaml"})
    if (!fs::is_regular_file(folder / name, none)) return {};
  if (settings_in(read_file(folder / "resolved.yaml")) != settings_in(session.resolved(folder))) return {};
  FinishedRun run;
  run.result = nlohmann::ordered_json::parse(read_file(folder / kFinishedRun), nullptr, false);
  if (!run.result.is_object() || !run.result.contains("exit_status") || !run.result["exit_status"].is_number_integer())
    return {};  // not whole: the run is made again
  run.status = run.result["exit_status"].get<int>();
  run.result.erase("exit_status");
  std::string planned;
  try {
    planned = read_plan(folder / "plan.json").assembly.sha256;
  } catch (const InputError&) {
    return {};  // no plan: the run is made again
  }
  if (planned != session.read(input, context).sha256) return {};
  run.result["kept"] = true;
  run.result["planned_seconds"] = run.result.value("wall_seconds", 0.0);
  return run;
}

}  // namespace dismantle::app
