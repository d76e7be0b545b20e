#include "verify/pocket/contractor.h"

#include <exception>
#include <semaphore>
#include <thread>
#include <utility>

namespace dismantle::verify {

struct Contractor::Helper {
  std::binary_semaphore begin{0}, done{0};
  const Pinned* pinned = nullptr;
  PoseCell* cell = nullptr;  // nothing: the end
  const PinList* in_use = nullptr;
  std::exception_ptr error;
  std::thread thread{[this] {
    while (true) {
      begin.acquire();
      if (cell == nullptr) return;
      try {
        contract(*cell, *pinned, *in_use);
      } catch (...) {
        error = std::current_exception();  // thrown again by who asked
      }
      done.release();
    }
  }};
};

Contractor::Contractor(const Pinned& pinned, unsigned threads) : pinned_(pinned) {
  if (threads < 2) return;
  helper_ = std::make_unique<Helper>();
  helper_->pinned = &pinned;
}

Contractor::~Contractor() {
  if (!helper_) return;
  helper_->cell = nullptr;
  helper_->begin.release();
  helper_->thread.join();
}

void Contractor::operator()(PoseCell& x, PoseCell& y, const PinList& in_use) {
  if (helper_) {
    helper_->cell = &y;
    helper_->in_use = &in_use;
    helper_->begin.release();
  }
  std::exception_ptr error;
  try {
    contract(x, pinned_, in_use);
    if (!helper_) contract(y, pinned_, in_use);
  } catch (...) {
    error = std::current_exception();  // thrown below, when the helper is done with what it was lent
  }
  if (helper_) {
    helper_->done.acquire();
    if (!error) error = std::exchange(helper_->error, nullptr);
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace dismantle::verify
