#include "dismantle/push_search/alternation.h"

#include <algorithm>

namespace dismantle::push {
namespace {

bool goes_on(const PathResult& result) { return result.outcome() == Outcome::depth_limit; }

/// Neither a path nor a limit of time or work has ended the search.
bool unsuccessful(const PathResult& result) { return goes_on(result) || result.outcome() == Outcome::exhausted; }

}  // namespace

Alternation::Alternation(const PathQuery& query, const Tactics& tactics, RunContext& context)
    : query_(query),
      tactics_(tactics),
      context_(context),
      translation_(query, MotionSpace::translation, tactics, context),
      rank_(tactics.first_rank) {
  translated_.fail(Outcome::depth_limit);
  rotated_.fail(Outcome::depth_limit);
}

Search& Alternation::rotation() {
  if (!rotation_) rotation_.emplace(query_, MotionSpace::rigid, tactics_, context_);
  return *rotation_;
}

std::uint64_t Alternation::cost() const { return translation_.cost() + (rotation_ ? rotation_->cost() : 0); }

/// Expands the first state with screws, if only they lead out. True if the call ends with that.
bool Alternation::try_screws(const Limits& limits) {
  if (!screw_first_) screw_first_ = translation_.needs_screw();
  if (!*screw_first_) return false;
  Limits first_state = limits;
  first_state.rank = 0;
  first_state.expansions = 1;
  rotated_ = rotation().run(first_state);
  if (!unsuccessful(rotated_)) return true;
  paused_ = goes_on(rotated_) && rotation_->paused();
  screw_first_ = paused_;
  return paused_;
}

/// Searches up to the next rank. False if the call ends with that.
bool Alternation::run_next(Limits limits) {
  limits.rank = rotates_ ? rank_ - std::min(rank_, tactics_.rotation_lag) : rank_;
  Search& search = rotates_ ? rotation() : translation_;
  PathResult& result = rotates_ ? rotated_ : translated_;
  if (goes_on(result)) result = search.run(limits);
  if (!unsuccessful(result)) return false;
  paused_ = goes_on(result) && search.paused();
  if (paused_) return false;
  if (rotates_) ++rank_;
  rotates_ = !rotates_;
  return true;
}

PathResult Alternation::run(const Limits& limits) {
  const std::uint64_t begin = cost();
  paused_ = false;
  if (try_screws(limits)) return merged(translated_, rotated_);
  Limits left = limits;
  while (goes_on(translated_) || goes_on(rotated_)) {
    left.pause_after = limits.pause_left(cost() - begin);
    if (!run_next(left)) break;
  }
  if (rotates_) return merged(translated_, rotated_);
  return rotation_ ? merged(rotated_, translated_) : translated_;
}

std::shared_ptr<const Reached> Alternation::reached() const {
  auto reached = std::make_shared<Reached>();
  reached->translation = translation_.tree();
  if (rotation_) reached->rigid = rotation_->tree();
  return reached;
}

}  // namespace dismantle::push
