#include "dismantle/side_by_side.h"

#include <atomic>
#include <exception>
#include <utility>

#include "dismantle/crew.h"

namespace dismantle {
namespace {

/// Looks at a number, of one who waits, before it sleeps: what it waits for mostly takes less time than to wake it.
constexpr int kLooks = 20'000;

void wait_for(const std::atomic<unsigned>& number, unsigned value) {
  for (int k = 0; k < kLooks; ++k)
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

struct SideBySide::Helper {
  std::atomic<bool> there{false};
  std::atomic<unsigned> begun{0}, done{0};      // pieces
  const std::function<void()>* work = nullptr;  // nothing: the end
  std::exception_ptr error;
  Crew::Offer offer;  // last: it waits for the thread, which uses the above

  void help() {
    there = true;
    for (unsigned piece = 1;; ++piece) {
      wait_for(begun, piece);
      if (work == nullptr) return;
      try {
        (*work)();
      } catch (...) {
        error = std::current_exception();  // thrown again by who asked
      }
      set(done, piece);
    }
  }
};

SideBySide::SideBySide(const RunContext& context) {
  if (!context.crew) return;
  helper_ = std::make_unique<Helper>();
  helper_->offer = context.crew->offer([helper = helper_.get()] { helper->help(); }, Crew::Rank::part);
}

SideBySide::~SideBySide() {
  if (!helper_ || helper_->offer.withdraw()) return;
  helper_->work = nullptr;
  set(helper_->begun, helper_->begun + 1);
}

void SideBySide::operator()(const std::function<void()>& first, const std::function<void()>& second) {
  if (!helper_ || !helper_->there) {
    first();
    second();
    return;
  }
  helper_->work = &second;
  const unsigned piece = helper_->begun + 1;
  set(helper_->begun, piece);
  std::exception_ptr error;
  try {
    first();
  } catch (...) {
    error = std::current_exception();  // thrown below, when the helper is done with what it was lent
  }
  wait_for(helper_->done, piece);
  if (!error) error = std::exchange(helper_->error, nullptr);
  if (error) std::rethrow_exception(error);
}

}  // namespace dismantle
