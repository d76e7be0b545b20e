/// The sum of the costs of many questions, asked on all threads of a run.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "best_order/segment.h"
#include "dismantle/executor.h"
#include "dismantle/step_check.h"

namespace dismantle::order {

/// Adds up verdicts in the order of their questions until one decides the sum: a refusal, an exception, or a sum above
/// `most`. The result does not depend on the threads: what later questions give, exceptions included, is not used, as
/// if they had not been asked.
class VerdictsInOrder {
 public:
  /// `times`: of each cost in the sum.
  VerdictsInOrder(std::size_t count, double most, double times) : most_(most), times_(times), found_(count) {}

  /// Calls ask(k) -> ObjectiveVerdict for k from 0 on, on several threads.
  template <class Ask>
  void find(const RunContext& context, const Ask& ask) {
    const auto one = [&](std::size_t k) {
      Found found;
      try {
        found.verdict = ask(k);
        for (StepVerdict& verdict : found.verdict.verdicts) {  // which may be large
          verdict.notes.clear();
          verdict.certificate.reset();
        }
      } catch (...) {  // of any type; sum() throws it if it decides
        found.error = std::current_exception();
      }
      add(k, std::move(found));
    };
    parallel_for(found_.size(), context, one, [this] { return decided(); });
  }

  bool decided() const { return decided_.load(std::memory_order_relaxed); }
  /// kForbidden after a refusal. @throws what the question that decided threw.
  double sum() const {
    if (!decided()) return sum_;
    const Found& last = *found_[known_ - 1];
    if (last.error) std::rethrow_exception(last.error);
    return last.verdict.refused ? kForbidden : sum_;
  }
  /// Of a question that is in the sum.
  const ObjectiveVerdict& operator[](std::size_t k) const { return found_[k]->verdict; }

 private:
  struct Found {
    ObjectiveVerdict verdict;
    std::exception_ptr error;
  };

  void add(std::size_t k, Found found) {
    const std::lock_guard lock(mutex_);
    found_[k] = std::move(found);
    while (!decided() && known_ < found_.size() && found_[known_]) {
      const Found& next = *found_[known_++];
      if (!next.error && !next.verdict.refused) sum_ += times_ * next.verdict.cost;
      decided_ = next.error != nullptr || next.verdict.refused || sum_ > most_;
    }
  }

  const double most_, times_;
  std::mutex mutex_;
  std::vector<std::optional<Found>> found_;
  std::size_t known_ = 0;  // questions that are in the sum, or have decided it
  double sum_ = 0;
  std::atomic<bool> decided_ = false;
};

}  // namespace dismantle::order
