/// The work of the server: the program itself, one run at a time, in a child process.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace dismantle::serve {

enum class JobState { queued, running, done, refused, cancelled, failed };
const char* name_of(JobState state);

/// One run of the program.
struct Job {
  std::string product, kind;         ///< kind: "plan" or "edit"
  std::vector<std::string> command;  ///< program and arguments; writes one JSON object as its last line
  double wall = 0;                   ///< s, until it is killed
};

/// What is known of the last job of a product.
struct JobReport {
  std::string kind;
  JobState state = JobState::queued;
  std::string progress;  ///< the last line that the program said
  double seconds = 0;
  std::string message;                               ///< why it is refused or has failed
  nlohmann::json result = nlohmann::json::object();  ///< the program's last line
};
nlohmann::json to_json(const JobReport& report);

/// What an ended run means. `output`: its standard output; `said`: the end of its standard error.
JobReport report_of(const std::string& kind, int exit_status, const std::string& output, const std::string& said);

/// A queue with at most one job of each product.
class Jobs {
 public:
  static constexpr std::size_t kMostQueued = 50;

  /// False: the product has a job that is not done, or the queue is full.
  bool add(Job job);
  /// False: the product has no job that could be cancelled.
  bool cancel(const std::string& product);
  bool busy(const std::string& product) const;
  std::optional<JobReport> report(const std::string& product) const;
  std::map<std::string, JobReport> reports() const;  ///< of all products

  /// Works until it should stop; a running job is then killed. The children belong to the thread that calls this.
  /// `begin` and `finish` are called before and after each job; `finish` with false when its result does not count.
  /// What they throw makes the job fail.
  void run(const std::function<bool()>& should_stop, const std::function<void(const Job&)>& begin,
           const std::function<void(const Job&, bool)>& finish);

 private:
  JobReport work(const Job& job, const std::function<bool()>& should_stop);

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Job> queue_;
  std::map<std::string, JobReport> reports_;
  std::string cancelled_;  // product whose running job is to be killed
};

}  // namespace dismantle::serve
