#include "blocking/confinements_ahead.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace dismantle::blocking {
namespace {

// The caller's flag and deadline cannot wake a sleeper, so they are looked at this often. Affects how soon an
// interruption is noticed, never an answer.
constexpr std::chrono::milliseconds kLookAgain{5};

}  // namespace

ConfinementsAhead::~ConfinementsAhead() {
  for (const auto& [pair, job] : jobs_) job.cancel.cancel();
  for (const auto& [pair, job] : jobs_)
    if (job.found.valid()) job.found.wait();
}

std::size_t ConfinementsAhead::working() const {
  return static_cast<std::size_t>(std::count_if(jobs_.begin(), jobs_.end(), [](const auto& job) {
    return job.second.found.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
  }));
}

void ConfinementsAhead::begin(std::span<const Pair> pairs, std::size_t threads, const RunContext& context) {
  for (const Pair& pair : pairs) {
    if (working() >= threads) return;
    if (jobs_.contains(pair)) continue;
    RunContext own;
    own.deadline = context.deadline;
    own.threads = 1;
    auto found =
        std::async(std::launch::async, [this, pair, own] { return judge_.confined(pair.first, pair.second, own); });
    jobs_.emplace(pair, Job{own.cancel, std::move(found)});
  }
}

std::optional<Confinement> ConfinementsAhead::answer(const Pair& pair, std::span<const Pair> next,
                                                     const RunContext& context) {
  const auto known = jobs_.find(pair);
  if (known == jobs_.end()) {
    begin(next, context.threads - 1, context);
    RunContext own = context;
    own.threads = working() == 0 ? context.threads : 1;
    return judge_.confined(pair.first, pair.second, own);
  }
  begin(next, context.threads, context);
  Job& job = known->second;
  while (job.found.wait_for(kLookAgain) != std::future_status::ready)
    if (context.should_stop()) job.cancel.cancel();
  Job ended = std::move(job);
  jobs_.erase(known);
  return ended.found.get();
}

}  // namespace dismantle::blocking
