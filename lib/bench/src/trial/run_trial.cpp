#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <new>
#include <sstream>

#include "dismantle/errors.h"
#include "dismantle/orders/order.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/read_file.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/session/session.h"
#include "trial/files.h"
#include "trial/search_file.h"

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
  Recorder(const fs::path& folder, const Session& session, const LoadedAssembly& loaded, const std::string& part)
      : folder_(folder), session_(session), loaded_(loaded), part_(part), progress_(TrialFiles(folder).progress) {}

  void operator()(const Disassembly& so_far, const DisassemblyStep& /*newest*/) {
    const std::vector<std::vector<PartId>>& groups = so_far.groups();
    std::size_t out = so_far.parts();
    for (std::size_t g = 0; g < groups.size(); ++g)
      if (g == 0 || groups[g].size() > 1) out -= groups[g].size();
    progress_ << fmt::format("{:.6f} {}\n", seconds_since(begin_), out) << std::flush;
    if (saved_ && seconds_since(last_) < 1) return;
    write_file(TrialFiles(folder_).plan, to_json(session_.plan_of(so_far, loaded_, {.part = part_})));
    saved_ = true;
    last_ = Clock::now();
  }

 private:
  fs::path folder_;
  const Session& session_;
  const LoadedAssembly& loaded_;
  const std::string part_;
  std::ofstream progress_;
  Clock::time_point begin_ = Clock::now(), last_;
  bool saved_ = false;
};

/// What the plan is like.
void measure(const Plan& plan, TrialResult& row) {
  const OrderMeasures measures = measures_of(order_of(plan), classes_of(plan.assembly));
  row.steps = plan.disassembly.size();
  row.direction_changes = measures.direction_changes;
  row.off_axis = measures.off_axis;
  if (!plan.assembly.box.empty()) row.path_length = measures.travel / plan.assembly.box.size().maxCoeff();
  row.path_turns = measures.turns;
  nlohmann::json checks = nlohmann::json::object();
  for (const PlanObjectiveItem& item : plan.objective.checks) checks[item.type] = item.cost;
  row.checks = checks.dump();
}

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
  // Forced steps would hide what a planner does not find.
  const Session session({request.config, {"run.force=off"}, {}});
  RunContext context = context_of_trial();
  const auto searches = std::make_shared<SearchFile>(TrialFiles(folder).searches, request.search_nodes);
  context.on_log = SearchRecorder{context.on_log, searches};
  context.threads = std::max(1u, session.config().run.threads);
  const fs::path input = input_of(request, [&](const fs::path& file) { return session.read(file, context); });
  const LoadedAssembly loaded = session.load(input, context);
  const Assembly& assembly = *loaded.assembly;
  session.check({.part = request.part});  // loads the planners: part of loading
  const double load_seconds = seconds_since(start);

  const Clock::time_point begin = Clock::now();
  if (const double timeout = session.config().run.timeout; timeout > 0)
    context.deadline = Deadline::after_seconds(timeout);
  Recorder recorder(folder, session, loaded, request.part);
  const RunResult result = session.plan(loaded, context, {request.part, std::ref(recorder)});
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
  measure(result.plan, row);
  row.load_seconds = load_seconds;
  row.prepare_seconds = result.prepare_seconds;
  row.plan_seconds = result.plan_seconds;
  row.solve_seconds = solve_seconds;
  row.proof_seconds = result.proof_seconds;
  row.attempts = result.counts.attempts;
  row.memoised = result.counts.memoised;
  std::map<std::string, double> counts = result.planner_counts;
  counts.insert(result.sequence_counts.begin(), result.sequence_counts.end());  // a name of both is the path planner's
  row.counts = nlohmann::json(counts).dump();
  row.simulated_steps = count("steps");
  row.nodes = count("nodes");
  row.collision_checks = count("state_checks");
  row.peak_rss_mb = peak_memory();
  write_result(row, folder);
}

void verify_trial(const fs::path& folder) {
  std::set_new_handler(end_without_memory);
  const TrialRequest request = read_request(folder);
  // Proofs and verdicts of third parties are checked by their plugins.
  const auto plugins = std::make_shared<Registry>();
  for (const std::string& path : request.plugins) plugins->add_search_path(path);
  const Session session = Session::reader(plugins);
  const RunContext context = context_of_trial();
  const Plan plan = read_plan(TrialFiles(folder).plan);
  const fs::path input = input_of(request, [&](const fs::path& file) { return session.read(file, plan, context); });
  const Assembly assembly = session.assembly_of(plan, input, context);
  // The tolerance is stated for an assembly of size 10, but a planner's configuration may scale to another size.
  const double size = assembly.normalization.scale * assembly.input_box.size().maxCoeff() / 10;
  const PlanCheck check = session.verify(plan, assembly, context, {.tolerance = request.max_penetration * size});
  auto problems = nlohmann::json::array();
  for (const auto& p : check.problems) problems.push_back(fmt::format("step {}: {}", p.step, p.message));
  const nlohmann::json json = {{"valid", check.valid},
                               {"complete", check.complete},
                               {"max_penetration", check.max_penetration / size},
                               {"problems", problems}};
  write_file(TrialFiles(folder).verification, json.dump(1) + "\n");
}

}  // namespace dismantle::bench
