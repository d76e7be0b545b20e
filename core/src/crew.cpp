#include "dismantle/crew.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace dismantle {

struct Crew::Work {
  enum class State : char { offered, running, done, withdrawn };
  std::function<void()> run;
  State state = State::offered;
  bool awaited = false;      // by one who has left his place
  bool hands_place = false;  // which he gets when it is done, before anybody else
  std::exception_ptr error;
};

struct Crew::Impl {
  explicit Impl(unsigned n) : threads(n) {}

  const unsigned threads;
  std::mutex mutex;
  std::condition_variable place_or_work, work_ended;
  std::deque<std::shared_ptr<Work>> parts, ahead;
  unsigned working = 1;
  bool untold = false;  // a place was left to an offer, and nobody has it yet
  bool stop = false;
  std::mutex idle_mutex;  // taken before `mutex`, or alone
  std::function<void()> idle;
  std::vector<std::jthread> helpers;

  bool place() const { return working < threads; }
  bool offers() const { return !parts.empty() || !ahead.empty(); }

  std::shared_ptr<Work> next() {
    auto& from = parts.empty() ? ahead : parts;
    std::shared_ptr<Work> work = std::move(from.front());
    from.pop_front();
    return work;
  }

  void tell_idle() {
    const std::scoped_lock calls(idle_mutex);
    if (!idle) return;
    {
      const std::scoped_lock lock(mutex);
      if (!place() || offers()) return;
    }
    idle();
  }

  /// To wait for `awaited`, if given, which must not be done.
  void leave(Work* awaited = nullptr) {
    bool offered = false;
    {
      const std::scoped_lock lock(mutex);
      if (awaited != nullptr) {
        if (awaited->state == Work::State::done) return;
        awaited->awaited = true;
      }
      --working;
      untold = offered = offers();
    }
    if (offered)
      place_or_work.notify_one();
    else
      tell_idle();
  }

  void enter() {
    const std::scoped_lock lock(mutex);
    ++working;
  }

  void help() {
    std::unique_lock lock(mutex);
    while (true) {
      place_or_work.wait(lock, [this] { return stop || (place() && offers()); });
      if (stop) return;
      const std::shared_ptr<Work> work = next();
      work->state = Work::State::running;
      ++working;
      const bool tell = std::exchange(untold, false) && place() && !offers();
      lock.unlock();
      if (tell) tell_idle();
      try {
        work->run();
      } catch (...) {
        work->error = std::current_exception();  // thrown again by who waits for it
      }
      work->run = nullptr;  // and what it holds
      lock.lock();
      work->state = Work::State::done;
      work->hands_place = work->awaited;
      work_ended.notify_all();
      if (work->hands_place) continue;
      lock.unlock();
      leave();
      lock.lock();
    }
  }
};

Crew::Offer& Crew::Offer::operator=(Offer&& other) noexcept {
  std::swap(crew_, other.crew_);
  std::swap(work_, other.work_);
  return *this;
}

Crew::Offer::~Offer() {
  if (!work_ || withdraw()) return;
  std::unique_lock lock(crew_->mutex);
  crew_->work_ended.wait(lock, [this] { return work_->state != Work::State::running; });
}

bool Crew::Offer::withdraw() {
  bool tell = false;
  {
    const std::scoped_lock lock(crew_->mutex);
    if (work_->state == Work::State::withdrawn) return true;
    if (work_->state != Work::State::offered) return false;
    std::erase(crew_->parts, work_);
    std::erase(crew_->ahead, work_);
    work_->state = Work::State::withdrawn;
    tell = crew_->untold && !crew_->offers();
    if (tell) crew_->untold = false;
  }
  if (tell) crew_->tell_idle();
  return true;
}

bool Crew::Offer::running() const {
  const std::scoped_lock lock(crew_->mutex);
  return work_->state == Work::State::running;
}

bool Crew::Offer::done() const {
  const std::scoped_lock lock(crew_->mutex);
  return work_->state == Work::State::done;
}

/// Asks `goes_on` so often; until it is done, or that says no.
void Crew::Offer::await(std::chrono::milliseconds often, const std::function<bool()>& goes_on) {
  crew_->leave(work_.get());
  std::unique_lock lock(crew_->mutex);
  while (!crew_->work_ended.wait_for(lock, often, [this] { return work_->state == Work::State::done; })) {
    lock.unlock();
    const bool on = goes_on();
    lock.lock();
    if (!on) break;
  }
  if (work_->awaited && !work_->hands_place) ++crew_->working;
  work_->awaited = work_->hands_place = false;
}

bool Crew::Offer::wait_for(std::chrono::milliseconds most) {
  await(most, [] { return false; });
  return done();
}

void Crew::Offer::wait() {
  constexpr std::chrono::milliseconds kLong{1000};
  await(kLong, [] { return true; });
  if (work_->error) std::rethrow_exception(work_->error);
}

void Crew::Offer::wait(const RunContext& context, const CancelToken& cancel) {
  // The caller's flag and deadline cannot wake a sleeper, so they are looked at this often. Affects how soon an
  // interruption is noticed, never an answer.
  constexpr std::chrono::milliseconds kLookAgain{5};
  await(kLookAgain, [&] {
    if (context.should_stop()) cancel.cancel();
    return true;
  });
  if (work_->error) std::rethrow_exception(work_->error);
}

Crew::Crew(unsigned threads) {
  if (threads < 1) throw std::invalid_argument("Crew: at least one thread");
  impl_ = std::make_shared<Impl>(threads);
  if (threads == 1) return;
  // One more than places are left beside the maker's: that one may wait for one of them.
  for (unsigned t = 0; t < threads; ++t) impl_->helpers.emplace_back([impl = impl_.get()] { impl->help(); });
}

Crew::~Crew() {
  {
    const std::scoped_lock lock(impl_->mutex);
    impl_->stop = true;
    for (auto* list : {&impl_->parts, &impl_->ahead}) {
      for (const auto& work : *list) work->state = Work::State::withdrawn;
      list->clear();
    }
  }
  impl_->place_or_work.notify_all();
  impl_->helpers.clear();
}

unsigned Crew::threads() const { return impl_->threads; }

Crew::Offer Crew::offer(std::function<void()> work, Rank rank) {
  auto offered = std::make_shared<Work>();
  offered->run = std::move(work);
  {
    const std::scoped_lock lock(impl_->mutex);
    (rank == Rank::part ? impl_->parts : impl_->ahead).push_back(offered);
  }
  impl_->place_or_work.notify_one();
  return {impl_, std::move(offered)};
}

bool Crew::try_enter() {
  const std::scoped_lock lock(impl_->mutex);
  if (!impl_->place()) return false;
  ++impl_->working;
  return true;
}

void Crew::enter() { impl_->enter(); }

void Crew::leave() { impl_->leave(); }

void Crew::when_idle(std::function<void()> call) {
  const std::scoped_lock calls(impl_->idle_mutex);
  impl_->idle = std::move(call);
}

}  // namespace dismantle
