#include "blocking/proofs_ahead.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace dismantle::blocking {
namespace {

using Kind = HoldQuestion::Kind;

/// Of what ways may cut in.
constexpr double kShareForSure = 1, kShareAtLast = 0.5;
constexpr std::size_t kOffered = 4;  // at a time

}  // namespace

ProofsAhead::~ProofsAhead() { drop_all_but({}); }  // the offers wait for their ends

const Certificate* ProofsAhead::ask(const HoldQuestion& q, const RunContext& context) const {
  switch (q.kind) {
    case Kind::cage:
      return oracle_.prove({{q.a, q.b}, ProofEffort::low, 1}, context);
    case Kind::flat:
      return oracle_.prove({{q.a, q.b}, ProofEffort::medium, 1}, context);
    case Kind::confined_for_sure:
      return oracle_.prove({{q.a, q.b}, ProofEffort::high, kShareForSure}, context);
    case Kind::confined_at_last:
      break;
  }
  return oracle_.prove({{q.a, q.b}, ProofEffort::high, kShareAtLast}, context);
}

std::size_t ProofsAhead::open() const {
  return static_cast<std::size_t>(
      std::count_if(jobs_.begin(), jobs_.end(), [](const auto& job) { return !job.second.offer.done(); }) +
      std::count_if(dropped_.begin(), dropped_.end(), [](const Job& job) { return !job.offer.done(); }));
}

/// What is known stays.
void ProofsAhead::drop_all_but(std::span<const HoldQuestion> wanted) {
  for (auto job = jobs_.begin(); job != jobs_.end();) {
    if (job->second.offer.done() || std::find(wanted.begin(), wanted.end(), job->first) != wanted.end()) {
      ++job;
      continue;
    }
    job->second.cancel.cancel();
    if (!job->second.offer.withdraw()) dropped_.push_back(std::move(job->second));
    job = jobs_.erase(job);
  }
  std::erase_if(dropped_, [](const Job& job) { return job.offer.done(); });
}

void ProofsAhead::begin(std::span<const HoldQuestion> wanted, const RunContext& context) {
  drop_all_but(wanted);
  if (!context.crew) return;
  for (const HoldQuestion& question : wanted) {
    if (open() >= kOffered) return;
    if (jobs_.contains(question)) continue;
    RunContext own;
    own.deadline = context.deadline;
    own.crew = context.crew;
    auto proof = std::make_shared<const Certificate*>(nullptr);
    Crew::Offer offer =
        context.crew->offer([this, question, own, proof] { *proof = ask(question, own); }, Crew::Rank::ahead);
    jobs_.emplace(question, Job{own.cancel, std::move(proof), std::move(offer)});
  }
}

const Certificate* ProofsAhead::answer(const HoldQuestion& question, std::span<const HoldQuestion> next,
                                       const RunContext& context) {
  std::vector<HoldQuestion> wanted{question};
  wanted.insert(wanted.end(), next.begin(), next.end());
  drop_all_but(wanted);
  const auto known = jobs_.find(question);
  if (known == jobs_.end() || known->second.offer.withdraw()) {
    if (known != jobs_.end()) jobs_.erase(known);
    begin(next, context);
    return ask(question, context);
  }
  Job job = std::move(known->second);
  jobs_.erase(known);
  begin(next, context);
  job.offer.wait(context, job.cancel);
  return *job.proof;
}

}  // namespace dismantle::blocking
