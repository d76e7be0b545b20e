#include "unfinished_run.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

#include "command.h"
#include "crash_handler.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/write_file.h"
#include "plan_report.h"
#include "settings.h"
#include "stopped.h"

namespace dismantle::app {
namespace {

namespace fs = std::filesystem;

/// Records `why` as the reason for every remaining part.
void blame(Plan& plan, const std::string& why) {
  if (plan.status != PlanStatus::partial) return;
  for (const std::string& part : plan.remaining) plan.unsolved.push_back({part, Outcome::crashed, {}, {}, why});
}

}  // namespace

void GiveUp::operator()() {
  const std::lock_guard lock(mutex_);
  const std::string why = fmt::format(
      "a plugin did not stop within {:g} s of {} (run.grace); it was at '{}', with simulator {}, path planner {}, "
      "sequence planner {}",
      config_.run.grace, context_.cancel.cancelled() ? "being interrupted" : "the end of its time (run.timeout)",
      console_.busy_with(), config_.simulator.type, config_.path_planner.type, config_.sequence_planner.type);
  console_.end_progress();
  console_.error(why);
  nlohmann::ordered_json json = {{"status", "error"}, {"message", why}};
  try {
    if (saver_ != nullptr) json = save(why);
  } catch (const std::exception& e) {
    console_.error(fmt::format("what was done could not be saved: {}", e.what()));
  }
  console_.result(json);
  std::fflush(nullptr);
  std::_Exit(kPluginFailed);
}

nlohmann::ordered_json GiveUp::save(const std::string& why) {
  RunResult result;
  result.plan = saver_->latest();
  blame(result.plan, "the run was ended: " + why);
  const auto files = write_all(result, *assembly_, folder_, console_);
  console_.text(fmt::format("{}wrote what was done to {}\n", summary_text(result.plan), folder_.string()));
  auto json = result_json(result, kPluginFailed, folder_ / "plan.json");
  json["message"] = why;
  return json;
}

int finish_for(const IsolatedEnd& end, const RunNotes& notes, const ConsoleOptions& options) {
  Console console(options);
  const fs::path file = notes.plan.get();
  if (end.interrupted) {
    console.error(end.why);
    console.result({{"status", "interrupted"},
                    {"message", end.why},
                    {"plan", file.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(file.string())}});
    return kInterrupted;
  }
  const std::string why = end.why + "; " + advice_after_crash(true);
  console.error(why);
  if (file.empty()) {
    console.result({{"status", "error"}, {"message", why}});
    return kPluginFailed;
  }
  RunResult result;
  result.plan = read_plan(file);
  blame(result.plan, "the run was ended: " + end.why);
  write_file(file, to_json(result.plan));
  nlohmann::ordered_json json = {{"status", "error"}};
  Assembly assembly;
  try {
    // Without the plugin that may have crashed.
    const Session session = Session::reader(std::make_shared<Registry>(built_in_plugin_folder()));
    RunContext context = context_of(session, console);
    assembly = stoppable(context, [&] { return session.load_plan(file, "", context).assembly; });
    write_all(result, assembly, file.parent_path(), console);
  } catch (const Error& e) {
    console.warning(fmt::format("plan.json is there, the animation and the page are not: {}", e.what()));
  }
  console.end_progress();
  console.text(fmt::format("{}wrote what was done to {}\n", summary_text(result.plan), file.parent_path().string()));
  json = result_json(result, kPluginFailed, file);
  json["message"] = why;
  console.result(json);
  return kPluginFailed;
}

}  // namespace dismantle::app
