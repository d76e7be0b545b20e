#include "dismantle/bench/campaign.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <set>
#include <thread>

#include "campaign/enlist.h"
#include "campaign/running_trial.h"
#include "dismantle/errors.h"
#include "store/owner.h"
#include "store/results.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string host_name() {
  const std::string host = this_host();
  return host.substr(0, host.find(' '));
}

/// Removes the folders of killed processes of this machine.
void clear_leftovers(const fs::path& work) {
  const std::string prefix = host_name() + "@";
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(work, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && !is_alive(name.substr(prefix.size()))) fs::remove_all(entry.path(), error);
  }
}

class Campaign {
 public:
  Campaign(const Suite& suite, const CampaignOptions& options, RunContext& context)
      : suite_(suite),
        options_(options),
        context_(context),
        work_(fs::absolute(options.folder) / "work" / (host_name() + "@" + this_owner())),
        enlistment_(enlist(suite, options)),
        results_(database_of(options)) {
    for (const auto& trial : enlistment_.trials) enlistment_.wanted.trials.push_back(trial.plan);
    replaced_ = results_.enlist(suite, enlistment_.wanted);
    for (const std::string& note : replaced_) context_.log(LogLevel::info, note);
    fs::create_directories(work_.parent_path());
    clear_leftovers(work_.parent_path());
    fs::create_directories(work_);
  }
  ~Campaign() {
    running_.clear();
    std::error_code error;
    fs::remove_all(work_, error);  // if this fails, the next run removes it
  }

  CampaignResult run() {
    count_again();
    done_before_ = tally_.done;
    show();
    while (!context_.cancel.cancelled()) {
      const bool more = fill();
      if (running_.empty() && !more) {
        count_again();
        if (tally_.done == tally_.total) break;
        std::this_thread::sleep_for(std::chrono::seconds(1));  // others run the rest; claim it if they die
        continue;
      }
      wait();
      take_ended();
      renew();
    }
    for (const auto& trial : running_) results_.release(trial->place());
    running_.clear();
    return result();
  }

 private:
  /// Returns false when there was nothing to claim.
  bool fill() {
    while (running_.size() < options_.jobs) {
      const auto place = results_.claim();
      if (!place) return false;
      try {
        running_.push_back(std::make_unique<RunningTrial>(*place, enlistment_.trials[*place], suite_, options_,
                                                          work_ / std::to_string(*place)));
      } catch (...) {
        results_.release(*place);
        throw;
      }
    }
    return true;
  }

  void wait() {
    std::vector<const process::Child*> children;
    for (const auto& trial : running_) children.push_back(&trial->child());
    process::Child::wait(children);
  }

  void take_ended() {
    for (std::size_t i = 0; i < running_.size();) {
      if (!running_[i]->ended()) {
        ++i;
        continue;
      }
      const RunningTrial& trial = *running_[i];
      results_.finish(trial.place(), trial.record());
      ++ran_;
      tell(trial);
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  void renew() {
    if (Clock::now() - renewed_ < kLease / 6) return;  // so that some renewals may be late
    for (const auto& trial : running_) results_.renew(trial->place());
    renewed_ = Clock::now();
  }

  void tell(const RunningTrial& trial) {
    const TrialPlan& key = enlistment_.trials[trial.place()].plan;
    const TrialResult& row = trial.record().result;
    count(key.planner, row.solved);
    const std::string refused = row.verified.value_or(true) ? "" : " (refused by the verifier)";
    context_.log(LogLevel::info,
                 fmt::format("{}/{} {} on {}, {}, seed {}: {}{}, {:.1f} s", tally_.done, tally_.total, key.planner,
                             key.assembly, key.variant, key.seed, row.outcome, refused, row.wall_seconds));
    show();
  }

  void count_again() {
    const Clock::time_point begin = Clock::now();
    tally_ = results_.tally();
    counted_ = Clock::now();
    counting_took_ = counted_ - begin;
  }

  /// Rows of other processes are counted only from time to time: counting many rows takes long.
  void count(const std::string& planner, bool solved) {
    if (Clock::now() - counted_ > 50 * counting_took_) return count_again();
    ++tally_.done;
    for (auto& [name, counts] : tally_.planners)
      if (name == planner) {
        counts.first += solved ? 1 : 0;
        ++counts.second;
      }
  }

  void show() {
    std::string detail;
    for (const auto& [planner, counts] : tally_.planners)
      detail += fmt::format("{}{} {}/{}", detail.empty() ? "" : ", ", planner, counts.first, counts.second);
    const auto here = tally_.done - done_before_;
    if (here > 0 && tally_.done < tally_.total) {
      const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
      detail +=
          fmt::format("; about {} left", duration_text(elapsed / double(here) * double(tally_.total - tally_.done)));
    }
    context_.progress("trials", static_cast<std::size_t>(tally_.done), static_cast<std::size_t>(tally_.total), detail);
  }

  CampaignResult result() {
    const Tally tally = results_.tally();
    CampaignResult out;
    out.total = static_cast<std::size_t>(tally.total);
    out.done = static_cast<std::size_t>(tally.done);
    for (const auto& planner : tally.planners) out.solved += static_cast<std::size_t>(planner.second.first);
    out.ran = ran_;
    out.replaced = replaced_;
    out.interrupted = context_.cancel.cancelled() && tally.done < tally.total;
    out.database = database_of(options_);
    return out;
  }

  const Suite& suite_;
  const CampaignOptions& options_;
  RunContext& context_;
  fs::path work_;
  Enlistment enlistment_;
  Results results_;
  std::vector<std::unique_ptr<RunningTrial>> running_;
  std::vector<std::string> replaced_;
  std::size_t ran_ = 0;
  std::int64_t done_before_ = 0;
  Tally tally_;
  Clock::duration counting_took_{};
  Clock::time_point begin_ = Clock::now(), renewed_ = Clock::now(), counted_ = Clock::now();
};

}  // namespace

fs::path database_of(const CampaignOptions& options) {
  return options.folder /
         (options.shards == 1 ? "results.db" : fmt::format("shard-{}-of-{}.db", options.shard, options.shards));
}

CampaignResult run_campaign(const Suite& suite, const CampaignOptions& options, RunContext& context) {
  return Campaign(suite, options, context).run();
}

std::string duration_text(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  const double minutes = seconds / 60;
  if (minutes < 60) return fmt::format("{:.0f} min", minutes);
  if (minutes < 48 * 60) return fmt::format("{} h {:.0f} min", static_cast<int>(minutes / 60), std::fmod(minutes, 60));
  return fmt::format("{:.1f} days", minutes / 60 / 24);
}

std::string dry_run_text(const Suite& suite, const CampaignOptions& options) {
  const auto all = matrix(suite);
  check_planners(suite, options.only);
  auto cells = shard_of(all, options.shard, options.shards);
  std::erase_if(cells, [&](const Cell& cell) { return !is_wanted(suite.planners[cell.planner].name, options.only); });
  std::set<std::int64_t> seeds;
  for (const auto& planner : suite.planners) seeds.insert(planner.seeds.begin(), planner.seeds.end());
  std::string out = fmt::format(
      "{}: {} assemblies, {} planners, {} variants, {}{} seeds: {} trials\n", suite.name, suite.assemblies.size(),
      suite.planners.size(), suite.variants.size(),
      std::ranges::all_of(suite.planners, [&](const auto& p) { return p.seeds.size() == seeds.size(); }) ? ""
                                                                                                         : "up to ",
      seeds.size(), all.size());
  if (options.shards > 1)
    out += fmt::format("shard {} of {}: {} of them\n", options.shard, options.shards, cells.size());
  if (!options.only.empty()) out += fmt::format("only {}: {} of them\n", fmt::join(options.only, ", "), cells.size());
  for (const auto& planner : suite.planners)
    out += fmt::format("  planner {}: {} + {} + {}{}\n", planner.name, planner.config.sequence_planner.type,
                       planner.config.path_planner.type, planner.config.simulator.type,
                       planner.seeds == suite.seeds ? "" : fmt::format(", {} seeds", planner.seeds.size()));
  for (const auto& variant : suite.variants)
    out += fmt::format("  variant {}:{}{}{}\n", variant.name, variant.rotate ? " turned at random" : " as it is",
                       variant.part.empty() ? "" : ", part " + variant.part,
                       variant.planners.empty() ? "" : fmt::format(", only {}", fmt::join(variant.planners, ", ")));
  for (const auto& a : suite.assemblies)
    out += fmt::format("  assembly {}{}{}\n", a.name, a.category.empty() ? "" : " [" + a.category + "]",
                       a.part.empty() ? "" : ", part " + a.part);
  const Limits& l = suite.limits;
  out += fmt::format("limits of a trial: {} of planning, {} of wall-clock time, {} of CPU time, {} MiB, {} thread{}\n",
                     l.timeout > 0 ? duration_text(l.timeout) : "any time", duration_text(l.wall_limit()),
                     duration_text(l.cpu_limit()), l.memory, l.threads, l.threads == 1 ? "" : "s");
  const double most = double(cells.size()) * (l.timeout > 0 ? l.timeout : l.wall_limit()) / options.jobs;
  out += fmt::format("at most about {} with --jobs {}: every trial up to its time limit", duration_text(most),
                     options.jobs);
  std::error_code error;
  if (!options.folder.empty() && fs::is_regular_file(database_of(options), error)) {
    Sqlite db(database_of(options), Sqlite::Mode::read);
    auto mean =
        db.prepare("SELECT count(*), avg(wall_seconds + coalesce(verify_seconds, 0)) FROM trials WHERE state = 'done'");
    if (mean.step() && mean.integer(0) > 0) {
      const double left = std::max(0.0, double(cells.size()) - double(mean.integer(0)));
      out += fmt::format("\n{} rows are there already, {:.1f} s each on average: about {} for the rest",
                         mean.integer(0), mean.number(1), duration_text(left * mean.number(1) / options.jobs));
    }
  }
  return out + "\n";
}

}  // namespace dismantle::bench
