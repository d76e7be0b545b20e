// dismantle plan INPUT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <utility>

#include "dismantle/command.h"
#include "dismantle/console.h"
#include "dismantle/engine/run.h"
#include "dismantle/errors.h"
#include "dismantle/host/planning_setup.h"
#include "dismantle/plan_files.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/settings.h"
#include "dismantle/watchdog.h"

namespace dismantle::app {
namespace {

namespace fs = std::filesystem;

struct PlanOptions {
  std::string input, folder, part;
  ConfigFlags config;
  ConsoleOptions console;
};

/// "gearbox/" -> "gearbox.plan", "x/gearbox.step" -> "gearbox.plan".
fs::path default_folder(const std::string& input) {
  std::error_code error;
  fs::path path = fs::absolute(input, error).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const fs::path name = fs::is_directory(path, error) ? path.filename() : path.stem();
  return (name.empty() ? "assembly" : name.string()) + ".plan";
}

bool any_crash(const RunResult& result) {
  return result.outcome == Outcome::crashed ||
         std::ranges::any_of(result.plan.unsolved, [](const PlanUnsolved& u) { return u.outcome == Outcome::crashed; });
}

/// `constrained`: the outcome says whether all was done that the constraints leave to do.
int status_of(const RunResult& result, const Assembly& assembly, bool one_part, bool constrained,
              const RunContext& context) {
  const bool done = one_part || constrained ? is_success(result.outcome) : result.plan.status == PlanStatus::complete;
  if (done) return one_part || unusable_parts(assembly).empty() ? kComplete : kPartial;
  if (context.cancel.cancelled()) return kInterrupted;
  return any_crash(result) ? kPluginFailed : kPartial;
}

nlohmann::ordered_json counters_json(const RunResult& result) {
  nlohmann::ordered_json out = {{"searches", result.counts.attempts},
                                {"remembered", result.counts.memoised},
                                {"proposed", result.counts.proposed},
                                {"refused", result.counts.refused}};
  for (const auto& [name, count] : result.sequence_counts)
    if (count == std::floor(count) && std::abs(count) < 1e15)
      out[name] = static_cast<std::int64_t>(count);
    else
      out[name] = count;
  return out;
}

nlohmann::ordered_json result_json(const RunResult& result, const Assembly& assembly, int status,
                                   const fs::path& plan) {
  const std::size_t parts = result.plan.assembly.parts.size(), left = result.plan.remaining.size();
  const char* words = status == kComplete      ? "complete"
                      : status == kInterrupted ? "interrupted"
                      : status == kPartial     ? "partial"
                                               : "error";
  nlohmann::ordered_json out = {{"status", words},
                                {"parts", parts},
                                {"steps", result.plan.disassembly.size()},
                                {"removed", parts - left},
                                {"left", left},
                                {"excluded", result.plan.assembly.excluded.size()},
                                {"unusable", unusable_parts(assembly)},
                                {"unsolved", result.plan.unsolved.size()},
                                {"assembly", std::string(to_string(result.plan.assembly_status))},
                                {"counters", counters_json(result)},
                                {"plan", plan.string()}};
  if (status == kPluginFailed) out["message"] = "a plugin failed; see 'unsolved' in the plan";
  return out;
}

/// Times and what was searched; the planners' own counters are for -v.
std::string effort_text(const RunResult& result, bool verbose) {
  std::string text =
      fmt::format("{:.1f} s of preparing, {:.1f} s of planning", result.prepare_seconds, result.plan_seconds);
  if (result.proof_seconds >= 0.05) text += fmt::format(", {:.1f} s of proofs", result.proof_seconds);
  text += fmt::format("; {} {}", result.counts.attempts, result.counts.attempts == 1 ? "path search" : "path searches");
  if (verbose) {
    text += fmt::format("; counters: {} remembered, {} proposed, {} refused", result.counts.memoised,
                        result.counts.proposed, result.counts.refused);
    for (const auto& [name, count] : result.sequence_counts) text += fmt::format(", {} {}", count, name);
  }
  return text + "\n";
}

/// What a run that a plugin holds up leaves behind. Called on the watchdog's thread; the others may be anywhere.
class GiveUp {
 public:
  GiveUp(const RunConfig& config, const RunContext& context, fs::path folder, Console& console)
      : config_(config), context_(context), folder_(std::move(folder)), console_(console) {}

  /// From now on there are steps to save. Both must outlive this.
  void has(const Assembly& assembly, const Saver& saver) {
    const std::lock_guard lock(mutex_);
    assembly_ = &assembly;
    saver_ = &saver;
  }

  [[noreturn]] void operator()() {
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

 private:
  nlohmann::ordered_json save(const std::string& why) {
    RunResult result;
    result.plan = saver_->latest();
    if (result.plan.status == PlanStatus::partial)
      for (const std::string& part : result.plan.remaining)
        result.plan.unsolved.push_back({part, Outcome::crashed, {}, {}, "the run was ended: " + why});
    const auto files = write_results(result, *assembly_, folder_, console_);
    console_.text(fmt::format("{}wrote what was done to {}\n", summary_text(result.plan), folder_.string()));
    auto json = result_json(result, *assembly_, kPluginFailed, folder_ / "plan.json");
    json["message"] = why;
    return json;
  }

  const RunConfig& config_;
  const RunContext& context_;
  const fs::path folder_;
  Console& console_;
  std::mutex mutex_;
  const Assembly* assembly_ = nullptr;
  const Saver* saver_ = nullptr;
};

int plan(const PlanOptions& options) {
  Console console(options.console);
  Registry registry;
  const RunConfig config = load_config(options.config.source(), registry);
  warn_of_problems(registry, console);
  const PlanningSetup setup = planning_setup_of(config, registry);
  RunContext context = context_of(config.run, console);

  const fs::path folder = options.folder.empty() ? default_folder(options.input) : fs::path(options.folder);
  PrepareReport report;
  if (!options.folder.empty()) open_output_folder(folder);
  remove_old_results(folder, options.input);
  GiveUp give_up(config, context, folder, console);
  std::optional<Watchdog> watchdog(std::in_place, context, config.run.grace, [&give_up] { give_up(); });
  const Assembly assembly = load_assembly(options.input, config, registry, context, report, options.part);
  RunOptions run_options = run_options_of(config, options.part);
  run_options.constraints = constraints_of(config.constraints, assembly);
  if (!run_options.constraints.empty() && options.part.empty() && !setup.sequence_planner->keeps_constraints())
    throw Error(fmt::format("there are constraints, and sequence planner '{}' does not keep any; 'blocking' does",
                            config.sequence_planner.type));
  open_output_folder(folder);
  write_file(folder / "resolved.yaml", resolved_yaml(config, registry, folder));

  Saver saver(folder / "plan.json", plan_before_first_step(assembly, run_options), console);
  give_up.has(assembly, saver);
  const RunResult result = run(assembly, setup, run_options, context, std::ref(saver));
  watchdog.reset();  // what follows is no plugin
  const auto files = write_results(result, assembly, folder, console);
  console.end_progress();

  const int status = status_of(result, assembly, !options.part.empty(), !run_options.constraints.empty(), context);
  std::string text = summary_text(result.plan) + effort_text(result, options.console.verbose);
  if (const auto names = unusable_parts(assembly); !names.empty())
    text +=
        fmt::format("{} of {} parts could not be used and {} not in the plan (see 'left out'): exit status 1\n",
                    names.size(), assembly.parts.size() + assembly.excluded.size(), names.size() == 1 ? "is" : "are");
  if (!result.plan.unsolved.empty())
    text += fmt::format("why, and what to do: dismantle explain {}\n", (folder / "plan.json").string());
  if (status == kInterrupted) text += "interrupted: this is what was done until then\n";
  text += fmt::format("wrote to {}:", folder.string());
  for (const auto& file : files) text += " " + file;
  console.text(text + "\n");
  console.result(result_json(result, assembly, status, folder / "plan.json"));
  return status;
}

}  // namespace

void add_plan(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("plan", "Find an order in which the parts come out, and a path for each");
  auto options = std::make_shared<PlanOptions>();
  command->add_option("INPUT", options->input, "Folder of mesh files (one part each), or one file with several parts")
      ->required()
      ->option_text(" ");
  command
      ->add_option("-o,--output", options->folder, "Folder for the results; default: NAME.plan here, for an input NAME")
      ->option_text("DIR");
  options->config.add_file_and_set(*command);
  options->config.add_key(*command, "--simulator", "simulator.type", "ID", "Simulator");
  options->config.add_key(*command, "--path-planner", "path_planner.type", "ID", "Path planner");
  options->config.add_key(*command, "--sequence-planner", "sequence_planner.type", "ID", "Sequence planner");
  command->add_option("--part", options->part, "Plan just this part's path, all other parts fixed")
      ->option_text("NAME");
  options->config.add_key(*command, "--seed", "run.seed", "N", "Seed");
  options->config.add_key(*command, "--path-timeout", "run.path_timeout", "S", "Seconds for one attempt, 0 = no limit");
  options->config.add_key(*command, "--timeout", "run.timeout", "S", "Seconds for the whole run, 0 = no limit");
  options->config.add_key(*command, "--threads", "run.threads", "N", "Threads, 0 = all cores");
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "Writes index.html (to look at in a browser), plan.json, plan.glb (the animation), precedence.dot and\n"
      "resolved.yaml; those of an earlier run in that folder are removed first. Ctrl-C once stops soon and saves,\n"
      "twice stops now.\n"
      "Exit status: 0 every part came out; 1 not so, or some parts could not be used; 2 usage or configuration;\n"
      "3 unusable input; 4 a plugin failed or did not stop; 130 interrupted.\n"
      "Examples:\n"
      "  dismantle sample machine -o gearbox\n"
      "  dismantle plan gearbox/\n"
      "  dismantle plan gearbox/ --part washer_1_4 --set path_planner.of.contact_search.motion=translation -o washer\n"
      "  dismantle plan gearbox/ --format json -q | tail -n 1");
  command->callback([&action, options] { action = [options] { return plan(*options); }; });
}

}  // namespace dismantle::app
