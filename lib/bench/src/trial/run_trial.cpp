#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <new>
#include <sstream>

#include "dismantle/errors.h"
#include "dismantle/host/planning_setup.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/read_file.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/preparation/assembly_of_plan.h"
#include "dismantle/preparation/flexible_parts.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/preparation/read_input.h"
#include "dismantle/verification/check_plan.h"
#include "trial/files.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Ends the process: code that catches std::bad_alloc could run at the limit forever.
void end_without_memory() {
  constexpr std::string_view text = "out of memory: the limit of the trial (limits.memory) is reached\n";
  if (::write(STDERR_FILENO, text.data(), text.size()) < 0) _exit(kOutOfMemory);
  _exit(kOutOfMemory);
}

/// Largest resident memory of this process so far, MiB; 0 when it is unknown.
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}

/// Warnings and errors go to standard error, from where they become TrialResult::last_words.
RunContext context_of_trial() {
  RunContext context;
  context.on_log = [](LogLevel level, std::string_view text) {
    if (level >= LogLevel::warning) fmt::print(stderr, "{}\n", text);
  };
  return context;
}

/// Records each step when it is found, so that a killed trial keeps its progress.
class Recorder {
 public:
  Recorder(const fs::path& folder, const Assembly& assembly, const RunOptions& options)
      : folder_(folder), assembly_(assembly), options_(options), progress_(TrialFiles(folder).progress) {}

  void operator()(const Disassembly& so_far, const DisassemblyStep& /*newest*/) {
    const std::vector<std::vector<PartId>>& groups = so_far.groups();
    std::size_t out = so_far.parts();
    for (std::size_t g = 0; g < groups.size(); ++g)
      if (g == 0 || groups[g].size() > 1) out -= groups[g].size();
    progress_ << fmt::format("{:.6f} {}\n", seconds_since(begin_), out) << std::flush;
    if (saved_ && seconds_since(last_) < 1) return;
    write_file(TrialFiles(folder_).plan, to_json(plan_of(so_far, assembly_, options_)));
    saved_ = true;
    last_ = Clock::now();
  }

 private:
  fs::path folder_;
  const Assembly& assembly_;
  const RunOptions& options_;
  std::ofstream progress_;
  Clock::time_point begin_ = Clock::now(), last_;
  bool saved_ = false;
};

/// Why parts remain, for the reader of the row.
std::string reasons_of(const Plan& plan) {
  std::string text;
  for (const auto& u : plan.unsolved)
    if (!u.message.empty()) text += fmt::format("{}: {}: {}\n", u.part, to_string(u.outcome), u.message);
  return text;
}

}  // namespace

void plan_trial(const fs::path& folder) {
  std::set_new_handler(end_without_memory);
  const Clock::time_point start = Clock::now();
  const TrialRequest request = read_request(folder);
  Registry registry;
  RunConfig config = load_config({request.config, {}, {}}, registry);
  config.run.force = ForceWhen::off;  // forced steps would hide what a planner does not find
  RunContext context = context_of_trial();
  context.threads = std::max(1u, config.run.threads);
  const ImportParams import_params = import_params_of(config, registry);
  const auto importers = importers_of(registry, import_params);
  const fs::path input = input_of(request, importers, context);
  ReadOptions read;
  read.max_triangles = config.assembly.max_triangles;
  InputParts parts = read_input(input, importers, read, context);
  std::vector<std::string> names;
  for (const auto& part : parts.parts) names.push_back(part.name);
  check_constraint_names(config, names, input.string());
  std::erase_if(parts.parts,
                [&](const auto& part) { return std::ranges::count(config.constraints.ignore, part.name) > 0; });
  PrepareReport report;
  Assembly assembly =
      prepare_assembly(std::move(parts.parts), input.string(), parts.sha256, config.assembly, context, report);
  assembly.import_params = import_params;
  declare_overlaps(config.constraints, assembly);
  report.flexible = with_declared(std::move(report.flexible), config.constraints.flexible, assembly);
  const PlanningSetup setup = planning_setup_of(config, registry);
  const double load_seconds = seconds_since(start);

  const Clock::time_point begin = Clock::now();
  if (config.run.timeout > 0) context.deadline = Deadline::after_seconds(config.run.timeout);
  RunOptions options = run_options_of(config, request.part);
  options.flexible = report.flexible;
  options.constraints = constraints_of(config.constraints, assembly);
  if (!options.constraints.empty() && request.part.empty() && !setup.sequence_planner->traits().keeps_constraints)
    throw Error(fmt::format("the suite has constraints, and sequence planner '{}' does not keep any",
                            config.sequence_planner.type));
  Recorder recorder(folder, assembly, options);
  const RunResult result = run(assembly, setup, options, context, std::ref(recorder));
  const double solve_seconds = seconds_since(begin);
  write_file(TrialFiles(folder).plan, to_json(result.plan));
  fmt::print(stderr, "{}", reasons_of(result.plan));
  const auto count = [&](const char* name) {
    const auto found = result.planner_counts.find(name);
    return found == result.planner_counts.end() ? std::nullopt : std::optional<double>(found->second);
  };
  TrialResult row;
  row.outcome = to_string(result.outcome);
  row.input = input.string();
  row.input_sha256 = assembly.sha256;
  row.parts = assembly.parts.size();
  row.excluded = assembly.excluded.size();
  row.left_together = result.plan.remaining.size();
  row.removed = *row.parts - *row.left_together;
  row.steps = result.plan.disassembly.size();
  row.load_seconds = load_seconds;
  row.prepare_seconds = result.prepare_seconds;
  row.plan_seconds = result.plan_seconds;
  row.solve_seconds = solve_seconds;
  row.proof_seconds = result.proof_seconds;
  row.attempts = result.counts.attempts;
  row.memoised = result.counts.memoised;
  row.counts = nlohmann::json(result.planner_counts).dump();
  row.simulated_steps = count("steps");
  row.nodes = count("nodes");
  row.collision_checks = count("state_checks");
  row.peak_rss_mb = peak_memory();
  write_result(row, folder);
}

void verify_trial(const fs::path& folder) {
  std::set_new_handler(end_without_memory);
  const TrialRequest request = read_request(folder);
  const fs::path file = TrialFiles(folder).plan;
  const Plan plan = plan_from_json(read_file(file), file.string());
  Registry registry;
  registry.scan();
  RunContext context = context_of_trial();
  const auto importers = importers_of(registry, plan.assembly.import_params);
  const fs::path input = input_of(request, importers, context);
  ReadOptions read;
  read.max_triangles = std::numeric_limits<std::int64_t>::max();
  const Assembly assembly =
      assembly_of_plan(plan, read_input(input, importers, read, context), input.string(), context);
  // The tolerance is stated for an assembly of size 10, but a planner's configuration may scale to another size.
  const double size = assembly.normalization.scale * assembly.input_box.size().maxCoeff() / 10;
  VerifyOptions options;
  options.max_penetration = request.max_penetration * size;
  const PlanCheck check = check_plan(plan, assembly, options, context, prover_of_kind(registry));
  auto problems = nlohmann::json::array();
  for (const auto& p : check.problems) problems.push_back(fmt::format("step {}: {}", p.step, p.message));
  const nlohmann::json json = {{"valid", check.valid},
                               {"complete", check.complete},
                               {"max_penetration", check.max_penetration / size},
                               {"problems", problems}};
  write_file(TrialFiles(folder).verification, json.dump(1) + "\n");
}

}  // namespace dismantle::bench
