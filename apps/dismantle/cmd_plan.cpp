// dismantle plan INPUT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "dismantle/command.h"
#include "dismantle/console.h"
#include "dismantle/engine/run.h"
#include "dismantle/errors.h"
#include "dismantle/host/planning_setup.h"
#include "dismantle/plan_io/animation.h"
#include "dismantle/plan_io/page.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/settings.h"
#include "dismantle/viewer_template.h"

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

/// Saves the plan while it grows, at most once a second: what a crash can cost is one second's steps.
class Saver {
 public:
  Saver(fs::path file, Console& console) : file_(std::move(file)), console_(console) {}

  void operator()(const Plan& plan) {
    save(plan);
    // Reported after it was saved: what the user has read is not lost.
    const PlanStep& step = plan.disassembly.back();
    std::string out, part_way;
    for (const auto& move : step.moves) {
      const bool leaves = std::any_of(step.separates.begin(), step.separates.end(), [&](const auto& group) {
        return std::find(group.begin(), group.end(), move.part) != group.end();
      });
      std::string& names = leaves ? out : part_way;
      names += (names.empty() ? "" : ", ") + move.part;
    }
    if (!out.empty()) out += " out";
    if (!part_way.empty()) out += (out.empty() ? "" : ", ") + part_way + " moved part-way";
    console_.line(fmt::format("step {}: {}, {} left ({:.2f} s)", step.step, out, plan.remaining.size(), step.seconds));
  }

 private:
  void save(const Plan& plan) {
    const auto now = std::chrono::steady_clock::now();
    if (saved_once_ && now - saved_ < std::chrono::seconds(1)) return;
    write_file(file_, to_json(plan));
    saved_once_ = true;
    saved_ = now;
  }

  fs::path file_;
  Console& console_;
  bool saved_once_ = false;
  std::chrono::steady_clock::time_point saved_;
};

/// Returns the names of the files in `folder`.
std::vector<std::string> write_results(const RunResult& result, const Assembly& assembly, const fs::path& folder,
                                       Console& console) {
  write_file(folder / "plan.json", to_json(result.plan));
  const auto glb = to_glb(result.plan, assembly);
  write_file(folder / "plan.glb", std::string(glb.begin(), glb.end()));
  write_file(folder / "precedence.dot", to_dot(result.plan, result.precedence));
  std::vector<std::string> files = {"plan.json", "plan.glb", "precedence.dot", "resolved.yaml"};
  if (const auto page_template = viewer_template()) {
    write_file(folder / "index.html", to_page(result.plan, assembly, *page_template));
    files.insert(files.begin(), "index.html");
  } else {
    console.warning(std::string("index.html was not written: ") + kNoViewer);
  }
  return files;
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
                                {"plan", plan.string()}};
  if (status == kPluginFailed) out["message"] = "a plugin failed; see 'unsolved' in the plan";
  return out;
}

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
  const Assembly assembly = load_assembly(options.input, config, registry, context, report, options.part);
  open_output_folder(folder);
  write_file(folder / "resolved.yaml", resolved_yaml(config, registry, folder));

  Saver saver(folder / "plan.json", console);
  RunOptions run_options = run_options_of(config, options.part);
  run_options.constraints = constraints_of(config.constraints, assembly);
  if (!run_options.constraints.empty() && options.part.empty() && !setup.sequence_planner->keeps_constraints())
    throw Error(fmt::format("there are constraints, and sequence planner '{}' does not keep any",
                            config.sequence_planner.type));
  const RunResult result = run(assembly, setup, run_options, context, std::ref(saver));
  const auto files = write_results(result, assembly, folder, console);
  console.end_progress();

  const int status = status_of(result, assembly, !options.part.empty(), !run_options.constraints.empty(), context);
  std::string text = summary_text(result.plan);
  text += fmt::format("{:.1f} s of preparing, {:.1f} s of planning, {} attempts ({} remembered)",
                      result.prepare_seconds, result.plan_seconds, result.counts.attempts, result.counts.memoised);
  if (result.counts.proposed > 0)
    text += fmt::format(", {} ways proposed ({} refused)", result.counts.proposed, result.counts.refused);
  if (result.proof_seconds >= 0.05) text += fmt::format(", {:.1f} s of proofs", result.proof_seconds);
  for (const auto& [name, count] : result.sequence_counts) text += fmt::format(", {} {}", count, name);
  text += "\n";
  if (const auto names = unusable_parts(assembly); !names.empty())
    text +=
        fmt::format("{} of {} parts could not be used and {} not in the plan (see 'left out'): exit status 1\n",
                    names.size(), assembly.parts.size() + assembly.excluded.size(), names.size() == 1 ? "is" : "are");
  if (status == kInterrupted) text += "interrupted: this is what was done until then\n";
  text += fmt::format("wrote to {}:", folder.string());
  for (const auto& file : files) text += " " + file;
  console.text(text + "\n");
  console.result(result_json(result, assembly, status, folder / "plan.json"));
  return status;
}

}  // namespace

void add_plan(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("plan", "Find an order in which the parts come out, and a way for each");
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
      "resolved.yaml. Ctrl-C once stops soon and saves.\n"
      "Examples:\n"
      "  dismantle plan gearbox/\n"
      "  dismantle plan gearbox/ --part shaft --set path_planner.of.contact_search.motion=rotation -o shaft\n"
      "  dismantle plan gearbox/ --format json -q | tail -n 1");
  command->callback([&action, options] { action = [options] { return plan(*options); }; });
}

}  // namespace dismantle::app
