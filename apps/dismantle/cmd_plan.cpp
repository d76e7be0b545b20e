// dismantle plan INPUT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <thread>
#include <utility>

#include "command.h"
#include "console.h"
#include "crash_handler.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/session/revision.h"
#include "dismantle/session/session.h"
#include "each_product.h"
#include "finished_run.h"
#include "frame_options.h"
#include "isolation.h"
#include "plan_files.h"
#include "plan_report.h"
#include "revision_report.h"
#include "settings.h"
#include "stopped.h"
#include "unfinished_run.h"
#include "watchdog.h"

namespace dismantle::app {
namespace {

namespace fs = std::filesystem;

struct PlanOptions {
  std::string input, folder, part, resume, from, show_unit;
  std::optional<std::size_t> after;
  bool each = false, keep_finished = false;
  unsigned jobs = 1;
  bool isolate = false;
  std::int64_t memory = 0;  // MiB, for an isolated run
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

bool third_party(const std::string& id) { return id.find('.') != std::string::npos; }

/// Keeps `notes` up to date during the run.
void take_notes(RunNotes& notes, const RunConfig& config, RunContext& context) {
  notes.chosen.set(fmt::format("simulator {}, path planner {}, sequence planner {}", config.simulator.type,
                               config.path_planner.type, config.sequence_planner.type));
  // A century counts as unlimited: longer times would overflow the ticks of the clock.
  const double century = 3.2e9;  // s
  notes.grace = static_cast<std::int64_t>(std::nano::den * std::min(config.run.grace, century));
  if (const double left = context.deadline.seconds_left(); left < century && config.run.grace > 0) {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    notes.end = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() +
                static_cast<std::int64_t>(std::nano::den * (left + std::min(config.run.grace, century)));
  }
  context.on_progress = [&notes, shown = context.on_progress](const ProgressEvent& event) {
    notes.busy.set(fmt::format("{} {}/{}: {}", event.phase, event.done, event.total, event.detail));
    if (shown) shown(event);
  };
}

/// `isolated`: this is the child process of a run with --isolate.
int plan(const PlanOptions& options, RunNotes& notes, bool isolated) {
  Console console(options.console);
  const auto watch_for_crashes = [&](const Registry* known) {
    report_crashes(known, notes, isolated ? AfterCrash::hand_over : AfterCrash::exit,
                   options.console.format == Format::json);
  };
  watch_for_crashes(nullptr);  // plugins run code while they are loaded
  const Session session(options.config.source());
  const RunConfig& config = session.config();
  watch_for_crashes(&session.registry());
  warn_of_problems(session, console);
  session.check({.part = options.part});
  RunContext context = context_of(session, console);
  take_notes(notes, config, context);

  const fs::path folder = options.folder.empty() ? default_folder(options.input) : fs::path(options.folder);
  std::optional<Plan> earlier;
  if (const std::string& file = options.resume.empty() ? options.from : options.resume; !file.empty()) {
    earlier = read_plan(file);
    std::error_code error;
    if (fs::equivalent(fs::absolute(file).parent_path(), folder, error))
      throw Error(fmt::format("{} would be written over: name another folder with -o", file));
  }
  if (!options.folder.empty()) open_output_folder(folder);
  if (options.keep_finished) {
    const auto run = stoppable(context, [&] { return finished_run(folder, options.input, session, context); });
    if (run) {
      console.result(run->result);
      return run->status;
    }
  }
  remove_old_results(folder, options.input);
  GiveUp give_up(config, context, folder, console);
  std::optional<Watchdog> watchdog(std::in_place, context, config.run.grace, [&give_up] { give_up(); });
  const LoadedAssembly loaded =
      stoppable(context, [&] { return session.load(options.input, context, {.part = options.part}); });
  const Assembly& assembly = *loaded.assembly;
  const TextUnit unit =
      text_unit(shown_in(input_frame(assembly), options.show_unit), assembly.input_box, "input units");
  Saver saver(folder / "plan.json", session, loaded, options.part, console);
  open_output_folder(folder);
  write_file(folder / "resolved.yaml", session.resolved(folder));

  const bool careful = isolated || third_party(config.simulator.type) || third_party(config.path_planner.type) ||
                       third_party(config.sequence_planner.type);
  give_up.has(assembly, saver);
  const std::string saved = (folder / "plan.json").string();
  if (careful) {
    saver.save_every_step();
    notes.plan.set(saved);
  }
  const auto on_step = [&](const Disassembly& so_far, const DisassemblyStep& newest) {
    saver(so_far, newest);
    notes.plan.set(saved);
  };
  PlanRequest request{.part = options.part, .on_step = on_step};
  if (!options.resume.empty()) {
    request.resume = &*earlier;
    request.resume_steps = options.after.value_or(Disassembly::kNow);
  }
  std::optional<KeptSteps> kept;
  if (!options.from.empty()) {
    kept = stoppable(context, [&] {
      return kept_steps(*earlier, assembly, constraints_of(config.constraints, assembly),
                        Verifier(assembly, config.verify, context), context);
    });
    request.steps = &kept->steps;
  }
  const RunResult result = stoppable(context, [&] { return session.plan(loaded, context, request); });
  watchdog.reset();  // no plugin runs after this
  const auto files = write_all(result, assembly, folder, console);
  console.end_progress();

  const int status = status_of(result, context);
  std::string text =
      summary_text(result.plan, options.console.verbose, unit) + effort_text(result, options.console.verbose);
  if (kept) text += kept_text(*kept, options.from);
  if (const auto names = unusable_parts(result.plan); !names.empty())
    text +=
        fmt::format("{} of {} parts could not be used and {} not in the plan (see 'left out'): exit status 1\n",
                    names.size(), assembly.parts.size() + assembly.excluded.size(), names.size() == 1 ? "is" : "are");
  if (!result.plan.unsolved.empty())
    text += fmt::format("why, and what to do: dismantle explain {}\n", (folder / "plan.json").string());
  if (status == kInterrupted) text += "interrupted: this is what was done until then\n";
  text += fmt::format("wrote to {}:", folder.string());
  for (const auto& file : files) text += " " + file;
  console.text(text + "\n");
  nlohmann::ordered_json json = result_json(result, status, folder / "plan.json");
  if (kept) json["revised"] = revised_json(*kept);
  if (options.keep_finished && (status == kComplete || status == kPartial) && !context.cancel.cancelled())
    write_finished(folder, status, json);
  console.result(std::move(json));
  return status;
}

/// What was given on the command line for every product: all but the input, the output and how much to print.
std::vector<std::string> options_for_each(const CLI::App& command) {
  std::vector<std::string> out;
  bool threads = false;
  unsigned jobs = 1;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_single_name();
    if (option->count() == 0 || option->get_positional()) continue;
    if (name == "jobs") jobs = option->as<unsigned>();
    if (name == "each" || name == "jobs" || name == "output" || name == "format" || name == "quiet" ||
        name == "verbose")
      continue;
    threads = threads || name == "threads";
    if (option->get_expected_max() == 0) {  // a flag
      out.push_back("--" + name);
      continue;
    }
    for (const std::string& value : option->results()) out.push_back(fmt::format("--{}={}", name, value));
  }
  // Jobs at the same time share the cores.
  if (!threads && jobs > 1)
    out.push_back(fmt::format("--threads={}", std::max(1u, std::thread::hardware_concurrency() / jobs)));
  return out;
}

int plan_products(const PlanOptions& options, const CLI::App& command) {
  Console console(options.console);
  if (options.folder.empty()) throw Error("--each needs a folder for the results: name it with -o");
  const Session session(options.config.source());
  warn_of_problems(session, console);
  session.check();
  return plan_each(
      {.folder = options.input, .output = options.folder, .jobs = options.jobs, .options = options_for_each(command)},
      session, console);
}

int plan(const PlanOptions& options) {
  if (!options.isolate) {
    static RunNotes notes;  // static because a signal handler reads them
    return plan(options, notes, false);
  }
  Isolation isolation(options.memory);
  if (isolation.in_child()) return plan(options, isolation.notes(), true);
  const IsolatedEnd end = isolation.wait();
  return end.exited ? end.status : finish_for(end, isolation.notes(), options.console);
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
  auto* resume = command->add_option("--resume", options->resume,
                                     "Go on from this plan of the same input; its steps are verified again");
  resume->option_text("PLAN");
  command->add_option("--after", options->after, "With --resume: keep only the first K steps of it")
      ->option_text("K")
      ->check(CLI::NonNegativeNumber.description(""))
      ->needs(resume);
  command
      ->add_option("--from", options->from,
                   "Keep the steps of this plan of an earlier revision that still verify, and plan the rest")
      ->option_text("OLD.json")
      ->excludes(resume);
  command->add_option("--part", options->part, "Plan just this part's path, all other parts fixed")
      ->option_text("NAME");
  options->config.add_components(*command);
  options->config.add_key(*command, "--target", "constraints.target", "NAME",
                          "Take this part out, in as few steps as possible");
  options->config.add_key(*command, "--seed", "run.seed", "N", "Seed");
  options->config.add_key(*command, "--path-timeout", "run.path_timeout", "S", "Seconds for one attempt, 0 = no limit");
  options->config.add_key(*command, "--timeout", "run.timeout", "S", "Seconds for the whole run, 0 = no limit");
  options->config.add_key(*command, "--unit", "assembly.unit", "UNIT", "Unit of an input that names none: mm, inch...");
  options->config.add_key(*command, "--up", "layout.up", "x|y|z|-x|-y|-z|X,Y,Z",
                          "What is up in the input's coordinates");
  options->config.add_key(*command, "--threads", "run.threads", "N", "Threads, 0 = all cores");
  auto* isolate = command->add_flag("--isolate", options->isolate,
                                    "Run in a child process: a plugin that crashes or hangs costs no finished step");
  isolate->option_text(" ");
  command
      ->add_option("--memory", options->memory,
                   "MiB of address space for the child process; default: what the machine has of memory")
      ->option_text("MIB")
      ->check(CLI::PositiveNumber.description(""))
      ->needs(isolate);
  auto* each = command->add_flag("--each", options->each,
                                 "INPUT is a folder of products: plan each file and sub-folder into DIR/NAME");
  each->option_text(" ")->excludes("--part")->excludes("--resume")->excludes("--from");
  command->add_option("--jobs", options->jobs, "With --each: number of products that are planned at the same time")
      ->check(CLI::Range(1u, 4096u))
      ->option_text("N")
      ->needs(each);
  command->add_flag("--keep-finished", options->keep_finished)->group("");  // for --each
  add_format(*command, options->console);
  add_show_unit(*command, options->show_unit);
  add_verbosity(*command, options->console);
  command->footer(
      "Writes index.html (to look at in a browser), plan.json, plan.glb (the animation), precedence.dot and\n"
      "resolved.yaml; those of an earlier run in that folder are removed first. Ctrl-C once stops soon and saves,\n"
      "twice stops now.\n"
      "With --each, DIR/summary.csv has a row for each product; a finished product whose files and settings are the\n"
      "same is kept, so that the same command goes on after Ctrl-C.\n"
      "Exit status: 0 what was asked for is done, every step verified; 1 not so, or some parts could not be used;\n"
      "2 usage or configuration; 3 unusable input; 4 a plugin failed or did not stop; 130 interrupted.\n"
      "Examples:\n"
      "  dismantle sample machine -o gearbox\n"
      "  dismantle plan gearbox/\n"
      "  dismantle plan gearbox/ --part washer_1_4 --set path_planner.of.contact_search.motion=translation -o washer\n"
      "  dismantle plan gearbox/ --format json -q | tail -n 1\n"
      "  dismantle sample peg_in_hole -o products/peg\n"
      "  dismantle plan --each products/ -o plans --jobs 2");
  command->callback([&action, options, command] {
    action = [options, command] { return options->each ? plan_products(*options, *command) : plan(*options); };
  });
}

}  // namespace dismantle::app
