#include "blocking/answers_ahead.h"

#include <utility>

namespace dismantle::blocking {

AnswersAhead::AnswersAhead(const Verifier& judge, unsigned threads) : judge_(judge) {
  for (unsigned t = 1; t < threads; ++t) workers_.emplace_back([this] { work(); });
}

AnswersAhead::~AnswersAhead() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  work_there_.notify_all();
  for (auto& worker : workers_) worker.join();
}

std::size_t AnswersAhead::waiting() const {
  const std::lock_guard lock(mutex_);
  return lines_.size();
}

void AnswersAhead::hint(std::deque<Line> lines) {
  {
    const std::lock_guard lock(mutex_);
    lines_ = std::move(lines);
  }
  work_there_.notify_all();
}

AnswersAhead::State AnswersAhead::ask(const PassQuestion& q) const {
  return judge_.passes(q.moving, q.still, q.still_at, q.way) ? State::free : State::blocked;
}

/// Answers a question that nobody works on yet. Without the lock while it does.
void AnswersAhead::settle(const PassQuestion& question, std::unique_lock<std::mutex>& lock) {
  states_[question.key] = State::running;
  lock.unlock();
  State state = State::running;
  try {
    state = ask(question);
  } catch (...) {  // as if it had not been asked; who asks again gets the exception
    lock.lock();
    states_.erase(question.key);
    answered_.notify_all();
    throw;
  }
  lock.lock();
  states_[question.key] = state;
  answered_.notify_all();
}

const PassQuestion* AnswersAhead::next_wanted() {
  while (!wanted_.empty()) {
    const PassQuestion* question = wanted_.front();
    wanted_.pop_front();
    if (!states_.contains(question->key)) return question;
  }
  return nullptr;
}

std::vector<char> AnswersAhead::answer(std::span<const PassQuestion> questions) {
  std::unique_lock lock(mutex_);
  std::vector<char> blocked;
  for (const auto& q : questions) wanted_.push_back(&q);
  if (questions.size() > 1 && works_ahead()) work_there_.notify_all();
  try {
    while (const PassQuestion* question = next_wanted()) settle(*question, lock);
    for (const auto& q : questions) {
      const auto decided = [&] {
        const auto known = states_.find(q.key);
        return known == states_.end() || known->second != State::running;
      };
      answered_.wait(lock, decided);
      if (!states_.contains(q.key)) settle(q, lock);  // a worker failed at it
      blocked.push_back(states_.at(q.key) == State::blocked);
    }
  } catch (...) {
    wanted_.clear();
    throw;
  }
  return blocked;
}

void AnswersAhead::work_on(const Line& line, std::unique_lock<std::mutex>& lock) {
  for (const auto& q : line) {
    if (stop_ || !wanted_.empty()) return;  // what the caller waits for comes first; it hints again
    const auto known = states_.find(q.key);
    if (known == states_.end()) settle(q, lock);
    if (states_.at(q.key) != State::free) return;
  }
}

void AnswersAhead::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    work_there_.wait(lock, [&] { return stop_ || !wanted_.empty() || !lines_.empty(); });
    if (stop_) return;
    try {
      if (const PassQuestion* question = next_wanted()) {
        const PassQuestion own = *question;  // outlives a caller that fails elsewhere
        settle(own, lock);
      } else if (!lines_.empty()) {
        const Line line = std::move(lines_.front());
        lines_.pop_front();
        work_on(line, lock);
      }
    } catch (...) {
      // The caller comes to the same question, if it matters, and meets the same exception.
    }
  }
}

}  // namespace dismantle::blocking
