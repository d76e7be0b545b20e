#include "campaign/running_trial.h"

#include <fmt/format.h>
#include <signal.h>

#include <fstream>

#include "dismantle/errors.h"
#include "dismantle/outcome.h"
#include "dismantle/plan_io/read_file.h"
#include "trial/files.h"
#include "trial/search_file.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;

/// Bytes. Keeps a planner that writes endlessly from filling the disk.
constexpr std::uint64_t kLargestFile = 1 << 30;

/// The outcome of a process that left no result. Names: docs/benchmark.md.
std::string outcome_of(const process::End& end) {
  if (end.out_of_wall) return "wall_limit";
  if (end.out_of_cpu) return "cpu_limit";
  if (end.signal == SIGKILL) return "killed";
  if (end.signal != 0) return "crash";
  if (end.status == kOutOfMemory) return "out_of_memory";
  if (end.status == 2) return "bad_configuration";
  if (end.status == 3) return "bad_input";
  if (end.status == 4) return "plugin_error";
  return "no_result";
}

void read_progress(const fs::path& file, TrialRecord& record) {
  std::ifstream in(file);
  double seconds = 0;
  std::int64_t removed = 0;
  while (in >> seconds >> removed) record.progress.emplace_back(seconds, removed);
}

}  // namespace

RunningTrial::RunningTrial(std::size_t place, const Enlisted& trial, const Suite& suite, const CampaignOptions& options,
                           fs::path folder)
    : place_(place),
      limits_(suite.limits),
      verify_cpu_(suite.verify_cpu),
      options_(options),
      folder_(std::move(folder)),
      one_part_(!trial.plan.part.empty()) {
  fs::remove_all(folder_);
  fs::create_directories(folder_);
  fs::create_directories(trial.request.inputs);
  write_request(trial.request, folder_);
  row_.started = utc_now();
  start(options.plan_command, limits_.wall_limit(), limits_.cpu_limit());
}

RunningTrial::~RunningTrial() {
  child_.reset();
  std::error_code error;
  fs::remove_all(folder_, error);  // if this fails, the next run removes it
}

void RunningTrial::start(const std::vector<std::string>& command, double wall, double cpu) {
  process::Program program{.command = command,
                           .limits = {.wall = wall,
                                      .cpu = cpu,
                                      .memory = static_cast<std::uint64_t>(limits_.memory) << 20,
                                      .file_size = kLargestFile},
                           .whole_tree = true};
  program.command.push_back(folder_.string());
  child_.emplace(program);
}

bool RunningTrial::ended() {
  if (!child_->ended()) return false;
  if (verifying_) {
    take_verification(child_->end());
    return true;
  }
  take_plan(child_->end());
  if (record_.plan.empty()) return true;
  verifying_ = true;
  start(options_.verify_command, 2 * verify_cpu_, verify_cpu_);
  return false;
}

void RunningTrial::take_plan(const process::End& end) {
  const TrialFiles files(folder_);
  read_progress(files.progress, record_);
  record_.searches = read_searches(files.searches);
  std::error_code error;
  if (fs::is_regular_file(files.plan, error)) record_.plan = read_file(files.plan);
  row_.outcome = outcome_of(end);
  if (!record_.progress.empty()) row_.removed = record_.progress.back().second;
  if (end.signal == 0 && end.status == 0 && fs::is_regular_file(files.result, error)) take_result();
  // What is measured here, or by the verifier, is not what the planning process says of itself.
  row_.solved = false;
  row_.verified.reset();
  row_.complete.reset();
  row_.signal = end.signal;
  row_.exit_status = end.status;
  row_.wall_seconds = end.wall_seconds;
  row_.cpu_seconds = end.cpu_seconds;
  if (row_.peak_rss_mb == 0) row_.peak_rss_mb = end.peak_rss_mb;
  row_.last_words.insert(0, end.last_words);
}

void RunningTrial::take_result() {
  try {
    read_result(folder_, row_);
    const auto outcome = outcome_from_string(row_.outcome);
    success_ = outcome && is_success(*outcome);
  } catch (const std::exception& e) {  // the file is damaged
    row_.outcome = "no_result";
    row_.last_words = fmt::format("\nthe result of the trial cannot be read: {}\n", e.what());
  }
}

void RunningTrial::take_verification(const process::End& end) {
  row_.verify_seconds = end.wall_seconds;
  std::error_code error;
  const fs::path file = TrialFiles(folder_).verification;
  if (end.signal != 0 || end.status != 0 || !fs::is_regular_file(file, error)) {
    row_.verification = fmt::format("no verification: {} {}", outcome_of(end), end.last_words);
    return;
  }
  try {
    const nlohmann::json j = read_json(file);
    row_.verified = j.at("valid").get<bool>();
    row_.complete = j.at("complete").get<bool>();
    row_.max_penetration = j.at("max_penetration").get<double>();
    for (const auto& problem : j.at("problems"))
      row_.verification += (row_.verification.empty() ? "" : "\n") + problem.get<std::string>();
    row_.solved = success_ && *row_.verified && (one_part_ || *row_.complete);
  } catch (const nlohmann::json::exception& e) {
    row_.verified.reset();
    row_.verification = fmt::format("no verification: {}", e.what());
  }
}

}  // namespace dismantle::bench
