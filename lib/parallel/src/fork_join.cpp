#include <atomic>
#include <exception>
#include <utility>

#include "dismantle/executor.h"

namespace dismantle {
namespace {

/// Spins for about ten microseconds before it sleeps: most waits are shorter than the time to wake a thread.
void wait_until(const std::atomic<unsigned>& number, unsigned value) {
  for (int k = 0; k < 20'000; ++k)
    if (number.load(std::memory_order_acquire) == value) return;
  for (unsigned now = number.load(std::memory_order_acquire); now != value;
       now = number.load(std::memory_order_acquire))
    number.wait(now, std::memory_order_acquire);
}

void set(std::atomic<unsigned>& number, unsigned value) {
  number.store(value, std::memory_order_release);
  number.notify_one();
}

}  // namespace

struct ForkJoin::Helper {
  std::atomic<bool> ready{false};
  std::atomic<unsigned> begun{0}, done{0};      // calls
  const std::function<void()>* work = nullptr;  // null: the helper ends
  std::exception_ptr error;
  Executor::TaskHandle task;  // last: its destructor waits for the thread, which uses the above

  void run() {
    ready = true;
    for (unsigned call = 1;; ++call) {
      wait_until(begun, call);
      if (work == nullptr) return;
      try {
        (*work)();
      } catch (...) {
        error = std::current_exception();  // rethrown by the caller
      }
      set(done, call);
    }
  }
};

ForkJoin::ForkJoin(const RunContext& context) {
  if (!context.executor || context.executor->threads() < 2) return;
  helper_ = std::make_unique<Helper>();
  helper_->task = context.executor->submit([helper = helper_.get()] { helper->run(); }, Executor::Priority::fork_join);
}

ForkJoin::~ForkJoin() {
  if (!helper_ || helper_->task.withdraw()) return;
  helper_->work = nullptr;
  set(helper_->begun, helper_->begun + 1);
}

void ForkJoin::operator()(const std::function<void()>& first, const std::function<void()>& second) {
  if (!helper_ || !helper_->ready) {
    first();
    second();
    return;
  }
  helper_->work = &second;
  const unsigned call = helper_->begun + 1;
  set(helper_->begun, call);
  std::exception_ptr error;
  try {
    first();
  } catch (...) {
    error = std::current_exception();  // rethrown below, after the helper has finished with `second`
  }
  wait_until(helper_->done, call);
  const std::exception_ptr second_error = std::exchange(helper_->error, nullptr);
  if (!error) error = second_error;
  if (error) std::rethrow_exception(error);
}

}  // namespace dismantle
