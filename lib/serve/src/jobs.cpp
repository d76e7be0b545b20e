#include "jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "dismantle/errors.h"
#include "dismantle/process/child.h"

namespace dismantle::serve {
namespace {

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of("\r\n");
  if (end == std::string::npos) return "";
  const std::size_t before = text.find_last_of("\r\n", end);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return text.substr(begin, end + 1 - begin);
}

}  // namespace

const char* name_of(JobState state) {
  switch (state) {
    case JobState::queued:
      return "queued";
    case JobState::running:
      return "running";
    case JobState::done:
      return "done";
    case JobState::refused:
      return "refused";
    case JobState::cancelled:
      return "cancelled";
    case JobState::failed:
      return "failed";
  }
  return "failed";
}

nlohmann::json to_json(const JobReport& report) {
  nlohmann::json out = {{"kind", report.kind},
                        {"state", name_of(report.state)},
                        {"progress", report.progress},
                        {"seconds", report.seconds},
                        {"message", report.message}};
  for (const char* key : {"status", "step", "steps", "parts", "removed", "left", "costs"})
    if (report.result.contains(key)) out[key] = report.result[key];
  return out;
}

JobReport report_of(const std::string& kind, int exit_status, const std::string& output, const std::string& said) {
  JobReport report;
  report.kind = kind;
  const auto json = nlohmann::json::parse(last_line(output), nullptr, false);
  if (json.is_object()) report.result = json;
  const std::string status = report.result.value("status", "");
  if (json.is_object() && status != "refused" && (exit_status == 0 || exit_status == 1)) {
    report.state = JobState::done;
    return report;
  }
  report.state = status == "refused" ? JobState::refused : JobState::failed;
  report.message = report.result.value("message", last_line(said));
  if (report.message.empty()) report.message = fmt::format("the program ended with exit status {}", exit_status);
  return report;
}

bool Jobs::busy(const std::string& product) const {
  const auto last = report(product);
  return last && (last->state == JobState::queued || last->state == JobState::running);
}

bool Jobs::add(Job job) {
  const std::lock_guard lock(mutex_);
  const auto last = reports_.find(job.product);
  const bool busy =
      last != reports_.end() && (last->second.state == JobState::queued || last->second.state == JobState::running);
  if (busy || queue_.size() >= kMostQueued) return false;
  JobReport report;
  report.kind = job.kind;
  reports_[job.product] = report;
  queue_.push_back(std::move(job));
  wake_.notify_one();
  return true;
}

bool Jobs::cancel(const std::string& product) {
  const std::lock_guard lock(mutex_);
  const auto found = reports_.find(product);
  if (found == reports_.end()) return false;
  if (found->second.state == JobState::running) {
    cancelled_ = product;
    return true;
  }
  if (found->second.state != JobState::queued) return false;
  std::erase_if(queue_, [&](const Job& job) { return job.product == product; });
  found->second.state = JobState::cancelled;
  return true;
}

std::optional<JobReport> Jobs::report(const std::string& product) const {
  const std::lock_guard lock(mutex_);
  const auto found = reports_.find(product);
  return found == reports_.end() ? std::nullopt : std::optional(found->second);
}

std::map<std::string, JobReport> Jobs::reports() const {
  const std::lock_guard lock(mutex_);
  return reports_;
}

JobReport Jobs::work(const Job& job, const std::function<bool()>& should_stop) {
  std::string output;
  process::Program program{.command = job.command, .limits = {.wall = job.wall}};
  program.whole_tree = true;
  program.output = [&](std::span<const std::byte> bytes) {
    output.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return output.size() < (std::size_t{16} << 20);
  };
  process::Child child(program);
  bool cancelled = false;
  while (!child.ended()) {
    const process::Child* const one[] = {&child};
    process::Child::wait(one);
    const std::lock_guard lock(mutex_);
    if (!cancelled && (cancelled_ == job.product || should_stop())) {
      cancelled = true;
      child.kill();
    }
    JobReport& report = reports_[job.product];
    report.progress = last_line(child.end().last_words);
    report.seconds = child.end().wall_seconds;
  }
  const process::End& end = child.end();
  JobReport report = report_of(job.kind, end.signal == 0 ? end.status : 128 + end.signal, output, end.last_words);
  if (end.out_of_wall) {
    report.state = JobState::failed;
    report.message = fmt::format("it took more than {:.0f} s and was ended", job.wall);
  } else if (cancelled) {
    report.state = JobState::cancelled;
  } else if (end.signal != 0) {
    report.message = fmt::format("the program was ended by signal {}", end.signal);
  }
  report.seconds = end.wall_seconds;
  return report;
}

void Jobs::run(const std::function<bool()>& should_stop, const std::function<void(const Job&)>& begin,
               const std::function<void(const Job&, bool)>& finish) {
  while (!should_stop()) {
    std::unique_lock lock(mutex_);
    if (!wake_.wait_for(lock, std::chrono::milliseconds(100), [&] { return !queue_.empty(); })) continue;
    const Job job = std::move(queue_.front());
    queue_.pop_front();
    cancelled_.clear();
    reports_[job.product].state = JobState::running;
    lock.unlock();
    JobReport report;
    try {
      begin(job);
      report = work(job, should_stop);
      finish(job, report.state == JobState::done);
    } catch (const Error& e) {
      report.kind = job.kind;
      report.state = JobState::failed;
      report.message = e.what();
    }
    lock.lock();
    reports_[job.product] = report;
  }
}

}  // namespace dismantle::serve
