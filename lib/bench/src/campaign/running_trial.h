/// A running trial: first the process that plans, then the process that verifies.
#pragma once

#include <optional>
#include <string>

#include "campaign/enlist.h"
#include "dismantle/process/child.h"

namespace dismantle::bench {

class RunningTrial {
 public:
  /// `folder`: owned by this trial; the destructor removes it.
  RunningTrial(std::size_t place, const Enlisted& trial, const Suite& suite, const CampaignOptions& options,
               std::filesystem::path folder);
  ~RunningTrial();
  RunningTrial(const RunningTrial&) = delete;
  RunningTrial& operator=(const RunningTrial&) = delete;

  std::size_t place() const { return place_; }
  const process::Child& child() const { return *child_; }
  /// True when the trial has ended; record() is then complete.
  bool ended();
  const TrialRecord& record() const { return record_; }

 private:
  /// Starts the process that plans or verifies. Each has times of its own: what the planner used up is not missing to
  /// the verifier.
  void start(const std::vector<std::string>& command, double wall, double cpu);
  void take_plan(const process::End& end);
  void take_result();
  void take_verification(const process::End& end);

  std::size_t place_;
  Limits limits_;
  double verify_cpu_;
  const CampaignOptions& options_;
  std::filesystem::path folder_;
  bool one_part_, verifying_ = false, success_ = false;
  std::optional<process::Child> child_;
  TrialRecord record_;
  TrialResult& row_ = record_.result;
};

}  // namespace dismantle::bench
