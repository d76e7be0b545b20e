// dismantle bench SUITE.yaml
#include <fmt/format.h>

#include <charconv>

#include "command.h"
#include "console.h"
#include "dismantle/bench/campaign.h"
#include "dismantle/bench/slurm.h"
#include "dismantle/bench/suite.h"
#include "dismantle/bench/trial.h"
#include "dismantle/errors.h"
#include "interrupt.h"
#include "settings.h"

namespace dismantle::app {
namespace {

namespace fs = std::filesystem;

struct BenchOptions {
  std::string suite, folder, shard, launcher = "local";
  unsigned jobs = 1, tasks = 1;
  std::vector<std::string> slurm_options, only;
  bool dry_run = false, replace = false;
  ConsoleOptions console;
};

/// "2/8".
void read_shard(const std::string& text, bench::CampaignOptions& options) {
  if (text.empty()) return;
  const std::size_t slash = text.find('/');
  const auto number = [](const std::string& word, unsigned& value) {
    const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
    return read.ec == std::errc{} && read.ptr == word.data() + word.size();
  };
  const bool good = slash != std::string::npos && number(text.substr(0, slash), options.shard) &&
                    number(text.substr(slash + 1), options.shards);
  if (!good || options.shard < 1 || options.shard > options.shards)
    throw Error(fmt::format("--shard {}: expected I/N with 1 <= I <= N, such as 2/8", text));
}

int run_locally(const bench::Suite& suite, const bench::CampaignOptions& campaign, Console& console) {
  RunContext context;
  console.attach(context);
  cancel_on_signals(context.cancel);
  const bench::CampaignResult result = bench::run_campaign(suite, campaign, context);
  console.end_progress();
  std::string text;
  for (const std::string& note : result.replaced) text += note + "\n";
  text += fmt::format("{} of {} trials done, {} solved; {} run now\nresults: {}\n", result.done, result.total,
                      result.solved, result.ran, result.database.string());
  if (result.interrupted) text += "interrupted: the same command goes on\n";
  text += fmt::format("tables: dismantle report {}\n", campaign.folder.string());
  console.text(text);
  const int status = result.interrupted ? kInterrupted : kComplete;
  console.result({{"status", result.interrupted ? "interrupted" : "complete"},
                  {"trials", result.total},
                  {"done", result.done},
                  {"solved", result.solved},
                  {"ran", result.ran},
                  {"replaced", result.replaced},
                  {"database", result.database.string()}});
  return status;
}

int run_by_slurm(const BenchOptions& options, const bench::CampaignOptions& campaign, Console& console) {
  bench::SlurmJob job;
  job.suite = options.suite;
  job.folder = campaign.folder;
  job.program = fs::read_symlink("/proc/self/exe");
  job.tasks = options.tasks;
  job.jobs = options.jobs;
  job.options = options.slurm_options;
  for (const std::string& planner : options.only) job.arguments.insert(job.arguments.end(), {"--only", planner});
  if (options.replace) job.arguments.emplace_back("--replace");
  const bench::Submitted submitted = bench::submit(job);
  console.text(
      fmt::format("wrote {}\nsubmitted as Slurm job {}, {} tasks\ntables, when they are done: dismantle report {}\n",
                  submitted.script.string(), submitted.id, options.tasks, campaign.folder.string()));
  console.result({{"status", "complete"}, {"job", submitted.id}, {"tasks", options.tasks}});
  return kComplete;
}

int bench_suite(const BenchOptions& options) {
  Console console(options.console);
  bench::CampaignOptions campaign;
  campaign.jobs = options.jobs;
  campaign.only = options.only;
  campaign.replace = options.replace;
  read_shard(options.shard, campaign);
  const bench::Suite suite = bench::read_suite(options.suite);
  for (const auto& note : suite.notes) console.warning(note);
  campaign.folder = options.folder.empty() ? fs::path(options.suite).stem().string() + ".bench" : options.folder;
  if (options.dry_run) {
    console.text(bench::dry_run_text(suite, campaign));
    console.result({{"status", "complete"}, {"trials", bench::matrix(suite).size()}});
    return kComplete;
  }
  open_output_folder(campaign.folder);
  if (options.launcher == "slurm") return run_by_slurm(options, campaign, console);
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  campaign.plan_command = {program, "bench-trial"};
  campaign.verify_command = {program, "bench-trial", "--verify"};
  return run_locally(suite, campaign, console);
}

}  // namespace

void add_bench(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("bench", "Run planners against assemblies, each trial in a process of its own");
  auto options = std::make_shared<BenchOptions>();
  command->add_option("SUITE.yaml", options->suite, "Suite (docs/benchmark.md)")->required()->option_text(" ");
  command->add_option("-o,--output", options->folder, "Folder for the results; default: SUITE.bench here")
      ->option_text("DIR");
  command->add_option("--jobs", options->jobs, "Number of trials that run in parallel")
      ->check(CLI::Range(1u, 4096u))
      ->option_text("N");
  command->add_option("--shard", options->shard, "Run just every N-th trial, into a database of its own")
      ->option_text("I/N");
  command->add_option("--launcher", options->launcher, "local, or slurm: submit a job array")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->option_text("local|slurm");
  command->add_option("--tasks", options->tasks, "slurm: tasks of the array, each a shard")
      ->check(CLI::Range(1u, 100000u))
      ->option_text("N");
  command->add_option("--slurm-option", options->slurm_options, "slurm: an option for sbatch; may be repeated")
      ->option_text("OPTION")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--only", options->only, "Run the trials of this planner of the suite; may be repeated")
      ->option_text("PLANNER")
      ->take_all()
      ->allow_extra_args(false);
  command
      ->add_flag("--replace", options->replace,
                 "Run rows again that were made with another configuration, plugin, limit or input; keep the others")
      ->option_text(" ");
  command->add_flag("--dry-run", options->dry_run, "Print the matrix and how long it may take")->option_text(" ");
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "The same command again goes on where it stopped. Ctrl-C puts running trials back.\n"
      "Examples:\n"
      "  dismantle bench configs/bench/smoke.yaml -o smoke --jobs 2\n"
      "  dismantle bench configs/bench/two_part.yaml --dry-run\n"
      "  dismantle bench suite.yaml -o big --only mine --replace\n"
      "  dismantle bench suite.yaml -o big --launcher slurm --tasks 64 --slurm-option=--partition=cpu");
  command->callback([&action, options] { action = [options] { return bench_suite(*options); }; });

  auto* trial = app.add_subcommand("bench-trial", "One trial, for `bench`")->group("");
  auto folder = std::make_shared<std::string>();
  auto verify = std::make_shared<bool>(false);
  trial->add_option("FOLDER", *folder, "Folder with request.json")->required();
  trial->add_flag("--verify", *verify, "Verify the plan that is there");
  trial->callback([&action, folder, verify] {
    action = [folder, verify] {
      *verify ? bench::verify_trial(*folder) : bench::plan_trial(*folder);
      return kComplete;
    };
  });
}

}  // namespace dismantle::app
