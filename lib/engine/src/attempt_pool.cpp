#include "attempt_pool.h"

#include <algorithm>
#include <chrono>
#include <set>

namespace dismantle {

namespace {

// A cancellation flag and a deadline cannot wake a sleeper, so the asking thread looks at them this often. Affects
// how soon an interruption is noticed, never an answer.
constexpr std::chrono::milliseconds kLookAgain{5};

}  // namespace

AttemptPool::AttemptPool(std::shared_ptr<Crew> crew, Compute compute, const RunContext& context)
    : compute_(std::move(compute)), deadline_(context.deadline), crew_(std::move(crew)) {
  for (unsigned i = 0; i < crew_->threads(); ++i) workers_.emplace_back([this, i] { work(i); });
  crew_->when_idle([this] {
    const std::lock_guard lock(mutex_);  // whoever is about to wait will do so before it is told
    work_there_.notify_all();
  });
}

AttemptPool::~AttemptPool() {
  crew_->when_idle(nullptr);
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    for (const auto& [key, job] : jobs_) job->cancel.cancel();
  }
  work_there_.notify_all();
  for (auto& worker : workers_) worker.join();
}

void AttemptPool::work(unsigned index) {
  std::unique_lock lock(mutex_);
  while (true) {
    work_there_.wait(lock, [this] { return stop_ || may_begin(); });
    if (stop_) return;
    const AttemptKey key = queue_.front();
    queue_.pop_front();
    const std::shared_ptr<Job> job = jobs_.at(key);
    job->running = true;
    job->begun = ++begun_;
    ++running_;
    RunContext context;
    context.deadline = job->deadline;
    context.cancel = job->cancel;
    context.crew = crew_;
    std::vector<LogLine> log;
    context.on_log = [&log](LogLevel level, std::string_view text) { log.push_back({level, std::string(text)}); };
    lock.unlock();
    ComputedAttempt computed = compute_(index, job->attempt, key, context);
    lock.lock();
    job->hands_place = job->has_own_place && job->awaited;
    if (job->has_own_place && !job->hands_place) {
      lock.unlock();
      crew_->leave();
      lock.lock();
    }
    --running_;
    job->running = false;
    job->done = true;
    job->result = {std::move(computed), std::move(log)};
    if (job->result.computed.interrupted && !job->asked) jobs_.erase(key);
    job_ended_.notify_all();
  }
}

/// True: the first in the queue has a place.
bool AttemptPool::may_begin() {
  if (queue_.empty()) return false;
  Job& job = *jobs_.at(queue_.front());
  job.has_own_place = !job.asked;
  return job.asked || crew_->try_enter();
}

void AttemptPool::hint(std::vector<std::pair<AttemptKey, Attempt>> attempts) {
  {
    const std::lock_guard lock(mutex_);
    std::set<AttemptKey> wanted;
    for (const auto& [key, attempt] : attempts) wanted.insert(key);
    for (const AttemptKey& key : queue_) jobs_.erase(key);
    queue_.clear();
    for (const auto& [key, job] : jobs_)
      if (job->running && !job->asked && !wanted.contains(key)) job->cancel.cancel();
    for (auto& [key, attempt] : attempts) {
      const auto [place, is_new] = jobs_.try_emplace(key);
      if (!is_new) continue;  // running, or computed
      place->second = std::make_shared<Job>();
      place->second->attempt = std::move(attempt);
      place->second->deadline = deadline_;
      queue_.push_back(key);
    }
  }
  work_there_.notify_all();
}

// When all workers are busy with attempts that nobody asked for, the one begun last makes way.
void AttemptPool::make_room() {
  if (running_ < workers_.size()) return;
  std::shared_ptr<Job> last;
  for (const auto& [key, job] : jobs_) {
    if (!job->running) continue;
    if (job->cancel.cancelled()) return;  // a worker is about to be free
    if (!job->asked && (!last || job->begun > last->begun)) last = job;
  }
  if (last) last->cancel.cancel();
}

// The job for a question, queued first in line unless it is running or computed.
std::shared_ptr<AttemptPool::Job> AttemptPool::demand(const AttemptKey& key, const Attempt& attempt,
                                                      const RunContext& context) {
  const auto [place, is_new] = jobs_.try_emplace(key);
  if (is_new) {
    place->second = std::make_shared<Job>();
    place->second->attempt = attempt;
  }
  const std::shared_ptr<Job> job = place->second;
  job->asked = true;
  if (!job->running && !job->done) {
    job->deadline = deadline_.earlier(context.deadline);
    std::erase(queue_, key);
    queue_.push_front(key);
    make_room();
    work_there_.notify_all();
  }
  return job;
}

PooledAttempt AttemptPool::take(const AttemptKey& key, const Attempt& attempt, const RunContext& context) {
  std::unique_lock lock(mutex_);
  while (true) {
    const std::shared_ptr<Job> job = demand(key, attempt, context);
    const bool my_place_is_free = job->running;  // it has its own
    if (my_place_is_free) {
      job->awaited = true;
      lock.unlock();
      crew_->leave();
      lock.lock();
    }
    while (!job->done) {
      job_ended_.wait_for(lock, kLookAgain, [&job] { return job->done; });
      if (job->done || !context.should_stop()) continue;
      job->cancel.cancel();
      if (job->running) continue;
      std::erase(queue_, key);  // never begun
      job->done = true;
      job->result.computed.interrupted = true;
      job->result.computed.answer.result.fail(Outcome::cancelled);
    }
    if (my_place_is_free && !job->hands_place) crew_->enter();
    PooledAttempt result = std::move(job->result);
    jobs_.erase(key);
    // Interrupted for a reason that is not the asker's (it had been computed ahead and was given up): once more.
    if (result.computed.interrupted && !context.should_stop()) continue;
    if (result.computed.interrupted && !context.cancel.cancelled()) {
      result.computed.answer.result.fail(Outcome::timeout, "the time limit of the whole run passed during the attempt");
    }
    return result;
  }
}

std::uint64_t AttemptPool::untaken() const {
  const std::lock_guard lock(mutex_);
  std::uint64_t count = 0;
  for (const auto& [key, job] : jobs_) count += job->done ? 1 : 0;
  return count;
}

}  // namespace dismantle
