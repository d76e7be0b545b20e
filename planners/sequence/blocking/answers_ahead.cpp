#include "blocking/answers_ahead.h"

#include <utility>

namespace dismantle::blocking {

AnswersAhead::AnswersAhead(const Verifier& judge, std::shared_ptr<Crew> crew)
    : judge_(judge), crew_(std::move(crew)), helpers_most_(crew_ ? crew_->threads() - 1 : 0) {}

AnswersAhead::~AnswersAhead() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  offers_.clear();
}

std::size_t AnswersAhead::waiting() const {
  const std::lock_guard lock(mutex_);
  return lines_.size();
}

void AnswersAhead::hint(std::deque<Line> lines) {
  const std::lock_guard lock(mutex_);
  lines_ = std::move(lines);
  if (!lines_.empty()) call_helpers(Crew::Rank::ahead);
}

/// With the lock.
void AnswersAhead::call_helpers(Crew::Rank rank) {
  std::erase_if(offers_, [](const Crew::Offer& offer) { return offer.done(); });
  for (; helpers_ < helpers_most_; ++helpers_) offers_.push_back(crew_->offer([this] { work(); }, rank));
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
  if (!lines_.empty()) call_helpers(Crew::Rank::ahead);  // the next of its line can be asked now
}

const PassQuestion* AnswersAhead::next_wanted() {
  while (!wanted_.empty()) {
    const PassQuestion* question = wanted_.front();
    wanted_.pop_front();
    if (!states_.contains(question->key)) return question;
  }
  return nullptr;
}

/// The next question of the first line on which nobody works.
std::optional<PassQuestion> AnswersAhead::next_hinted() {
  for (Line& line : lines_) {
    while (!line.empty()) {
      const auto known = states_.find(line.front().key);
      if (known == states_.end()) return line.front();
      if (known->second == State::running) break;
      if (known->second == State::blocked)
        line.clear();
      else
        line.pop_front();
    }
  }
  std::erase_if(lines_, [](const Line& line) { return line.empty(); });
  return std::nullopt;
}

std::vector<char> AnswersAhead::answer(std::span<const PassQuestion> questions) {
  std::unique_lock lock(mutex_);
  std::vector<char> blocked;
  for (const auto& q : questions) wanted_.push_back(&q);
  if (questions.size() > 1) call_helpers(Crew::Rank::part);
  try {
    while (const PassQuestion* question = next_wanted()) settle(*question, lock);
    for (const auto& q : questions) {
      while (true) {
        const auto known = states_.find(q.key);
        if (known == states_.end()) {
          settle(q, lock);  // a worker failed at it
        } else if (known->second != State::running) {
          break;
        } else if (const auto next = next_hinted()) {  // rather than wait
          settle(*next, lock);
        } else {
          answered_.wait(lock);
        }
      }
      blocked.push_back(states_.at(q.key) == State::blocked);
    }
  } catch (...) {
    wanted_.clear();
    throw;
  }
  return blocked;
}

/// Until there is nothing left; who has something then calls again.
void AnswersAhead::work() {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    try {
      if (const PassQuestion* question = next_wanted()) {
        const PassQuestion own = *question;  // outlives a caller that fails elsewhere
        settle(own, lock);
      } else if (const auto next = next_hinted()) {
        settle(*next, lock);
      } else {
        break;
      }
    } catch (...) {
      // The caller comes to the same question, if it matters, and meets the same exception. Nobody else is to try it.
      lines_.clear();
    }
  }
  --helpers_;
}

}  // namespace dismantle::blocking
