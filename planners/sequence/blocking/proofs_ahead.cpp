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
  drop_all_but({});
  for (const Job& job : dropped_) job.found.wait();
}

bool ConfinementsAhead::Job::works() const {
  return found.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

std::size_t ConfinementsAhead::working() const {
  return static_cast<std::size_t>(
      std::count_if(jobs_.begin(), jobs_.end(), [](const auto& job) { return job.second.works(); }) +
      std::count_if(dropped_.begin(), dropped_.end(), [](const Job& job) { return job.works(); }));
}

/// What is known stays.
void ConfinementsAhead::drop_all_but(std::span<const Question> wanted) {
  for (auto job = jobs_.begin(); job != jobs_.end();) {
    if (!job->second.works() || std::find(wanted.begin(), wanted.end(), job->first) != wanted.end()) {
      ++job;
      continue;
    }
    job->second.cancel.cancel();
    dropped_.push_back(std::move(job->second));
    job = jobs_.erase(job);
  }
  std::erase_if(dropped_, [](const Job& job) { return !job.works(); });
}

void ConfinementsAhead::begin(std::span<const Question> wanted, std::size_t threads, const RunContext& context) {
  drop_all_but(wanted);
  for (const Question& question : wanted) {
    if (working() >= threads) return;
    if (jobs_.contains(question)) continue;
    RunContext own;
    own.deadline = context.deadline;
    own.threads = 1;
    auto found = std::async(std::launch::async, [this, question, own] {
      return judge_.confined(question.a, question.b, own, question.share);
    });
    jobs_.emplace(question, Job{own.cancel, std::move(found)});
  }
}

std::optional<Confinement> ConfinementsAhead::answer(const Question& question, std::span<const Question> next,
                                                     const RunContext& context) {
  std::vector<Question> wanted{question};
  wanted.insert(wanted.end(), next.begin(), next.end());
  drop_all_but(wanted);
  const auto known = jobs_.find(question);
  if (known == jobs_.end()) {
    begin(next, context.threads - 1, context);
    RunContext own = context;
    own.threads = working() == 0 ? context.threads : 1;
    return judge_.confined(question.a, question.b, own, question.share);
  }
  Job& job = known->second;
  begin(wanted, job.works() ? context.threads : context.threads - 1, context);  // the caller only waits
  while (job.found.wait_for(kLookAgain) != std::future_status::ready)
    if (context.should_stop()) job.cancel.cancel();
  Job ended = std::move(job);
  jobs_.erase(known);
  return ended.found.get();
}

}  // namespace dismantle::blocking
