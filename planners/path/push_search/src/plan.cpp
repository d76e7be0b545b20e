#include "dismantle/push/plan.h"

#include <algorithm>
#include <utility>

#include "dismantle/path/ended_search.h"
#include "dismantle/path/time_limit.h"

namespace dismantle::push {
namespace {

/// The result of the later search, with the statistics and obstacles of the earlier one.
PathResult merged(const PathResult& earlier, PathResult later) {
  later.stats += earlier.stats;
  for (const PartId part : earlier.blocked_by)
    if (std::find(later.blocked_by.begin(), later.blocked_by.end(), part) == later.blocked_by.end())
      later.blocked_by.push_back(part);
  if (later.message.empty() && later.outcome() != Outcome::solved) later.message = earlier.message;
  return later;
}

/// The tree of an earlier search in that motion space; null if there is none.
const Tree* reached_in(const PathQuery& query, MotionSpace space) {
  const auto* reached = dynamic_cast<const Reached*>(query.resume_from);
  if (reached == nullptr) return nullptr;
  const std::optional<Tree>& tree = space == MotionSpace::translation ? reached->translation : reached->rigid;
  return tree ? &*tree : nullptr;
}

/// True for searches with `motion: auto` that follow screws: they first test whether only a screw leads out.
bool may_screw(const PathQuery& query, const Tactics& tactics) {
  return tactics.motion == Motion::automatic && query.goal.any_of.empty() && !tactics.turning.empty() &&
         tactics.turning.front() == Stage::twists;
}

Search begun(const PathQuery& query, MotionSpace space, const Tactics& tactics, RunContext& context) {
  Search search(query, space, tactics, context);
  if (const Tree* tree = reached_in(query, space)) search.resume(*tree);
  return search;
}

/// The rest of `pause_after` once `used` is spent. At least 1, so that the search advances; 0 = no pause.
std::uint64_t rest_of_pause(std::uint64_t pause_after, std::uint64_t used) {
  return pause_after == 0 ? 0 : std::max<std::uint64_t>(pause_after - std::min(pause_after, used), 1);
}

/// The search ended without a path, but not because of a limit of time or steps.
bool ended_without_path(const PathResult& result) {
  return result.outcome() == Outcome::exhausted || result.outcome() == Outcome::depth_limit;
}

}  // namespace

Capabilities required() { return {.dynamics = true, .contacts = true, .distance = false, .max_moving = 1}; }

bool fits(const PathQuery& query) {
  const Capabilities has = query.simulator.capabilities();
  return has.dynamics && has.contacts && has.max_moving >= query.scene.moving.size();
}

ByTurns::ByTurns(const PathQuery& query, const Tactics& tactics, RunContext& context)
    : query_(query),
      tactics_(tactics),
      context_(context),
      translation_(begun(query, MotionSpace::translation, tactics, context)),
      rank_(tactics.first_rank) {
  first_.fail(Outcome::depth_limit);
  second_.fail(Outcome::depth_limit);
}

PathResult ByTurns::run(const Search::Limits& limits) {
  const auto goes_on = [](const PathResult& r) { return r.outcome() == Outcome::depth_limit; };
  const auto cost = [&] { return translation_.cost() + (rotation_ ? rotation_->cost() : 0); };
  const std::uint64_t begin = cost();
  paused_ = false;
  Search::Limits turn = limits;
  if (!screw_first_) screw_first_ = may_screw(query_, tactics_) && translation_.screw_leads_out();
  if (*screw_first_) {
    if (!rotation_) rotation_.emplace(begun(query_, MotionSpace::rigid, tactics_, context_));
    turn.rank = 0;
    turn.expansions = 1;
    second_ = rotation_->run(turn);
    if (!goes_on(second_) && second_.outcome() != Outcome::exhausted) return merged(first_, second_);
    paused_ = goes_on(second_) && rotation_->paused();
    if (paused_) return merged(first_, second_);
    screw_first_ = false;
    turn = limits;
  }
  while (goes_on(first_) || goes_on(second_)) {
    turn.pause_after = rest_of_pause(limits.pause_after, cost() - begin);
    turn.rank = turning_ ? rank_ - std::min(rank_, tactics_.turning_lag) : rank_;
    if (turning_ && !rotation_) rotation_.emplace(begun(query_, MotionSpace::rigid, tactics_, context_));
    Search& search = turning_ ? *rotation_ : translation_;
    PathResult& result = turning_ ? second_ : first_;
    if (goes_on(result)) result = search.run(turn);
    if (!goes_on(result) && result.outcome() != Outcome::exhausted) break;
    paused_ = goes_on(result) && search.paused();
    if (paused_) break;
    if (turning_) ++rank_;
    turning_ = !turning_;
  }
  if (turning_) return merged(first_, second_);
  return rotation_ ? merged(second_, first_) : first_;
}

std::shared_ptr<const Reached> ByTurns::reached() const {
  auto reached = std::make_shared<Reached>();
  reached->translation = translation_.tree();
  if (rotation_) reached->rigid = rotation_->tree();
  return reached;
}

/// Under a depth limit the sequence planner asks for all parts in turn. Most of them are blocked, so the search has to
/// end soon. A part can slide or rotate in its play for a long time, so simulated steps are limited, too. Where parts
/// move independently, a state has many more actions, so only simulated steps are limited; and rotation is searched
/// from the first level on, because usually one of the parts rotates.
std::vector<ContactSearch::Leg> ContactSearch::legs_of(const PathQuery& query, const Tactics& tactics) {
  if (tactics.motion != Motion::automatic)
    return {{tactics.motion == Motion::translation ? MotionSpace::translation : MotionSpace::rigid}};
  const unsigned depth = query.budget.max_depth;
  const auto level = static_cast<std::uint64_t>(depth);
  const std::uint64_t share = static_cast<std::uint64_t>(tactics.level_steps) * level;
  if (!query.goal.any_of.empty()) {
    const unsigned rank = 1 + depth / 2;  // one driven, and two along one axis; from the
                                          // second level on also two across
    return {{MotionSpace::translation, rank, 0, share}, {MotionSpace::rigid, rank, 0, share}};
  }
  // The rank is limited to the depth: at the first level, free directions and axes.
  std::vector<Leg> legs{
      {MotionSpace::translation, depth, static_cast<std::uint64_t>(tactics.translation_nodes) * level, share}};
  if (depth > 1)
    legs.push_back({MotionSpace::rigid, depth, static_cast<std::uint64_t>(tactics.rotation_nodes) * level, share});
  return legs;
}

ContactSearch::ContactSearch(const PathQuery& query, const Tactics& tactics, RunContext& context,
                             std::function<void()> between)
    : query_(query),
      tactics_(tactics),
      context_(context),
      between_(std::move(between)),
      deadline_(path::deadline_of(query.budget)),
      steps_left_(query.budget.max_steps) {
  if (tactics.motion == Motion::automatic && query.budget.max_depth == 0)
    turns_.emplace(query, tactics, context);
  else
    legs_ = legs_of(query, tactics);
  now_.fail(Outcome::depth_limit);
}

SearchStatus ContactSearch::run(const Budget& portion) {
  const Deadline end = path::deadline_of(portion);
  Search::Limits limits;
  limits.deadline = deadline_.earlier(end);
  limits.steps_left = query_.budget.max_steps > 0 ? &steps_left_ : nullptr;
  limits.pause_after = portion.max_steps;
  limits.between = between_;
  if (is_success(now_.outcome())) return SearchStatus::solved;
  if (turns_) {
    now_ = turns_->run(limits);
    if (turns_->paused()) return SearchStatus::paused;
  } else if (const SearchStatus status = run_legs(limits); status == SearchStatus::paused) {
    return status;
  }
  const bool only_the_portion = now_.outcome() == Outcome::timeout && end.passed() && !deadline_.passed() &&
                                !context_.deadline.passed() && (query_.budget.max_steps == 0 || steps_left_ > 0);
  return only_the_portion ? SearchStatus::paused : status_of(now_.outcome());
}

/// If only a screw leads out, a leg for screws comes before the others.
void ContactSearch::put_screws_first() {
  if (std::exchange(asked_for_screws_, true) || legs_.empty() || !may_screw(query_, tactics_)) return;
  const Leg translation = legs_.front();
  Search search = begun(query_, translation.space, tactics_, context_);
  if (search.screw_leads_out())
    legs_.insert(legs_.begin(), {MotionSpace::rigid, 0, 1, translation.share});
  else
    begin_leg(translation, std::move(search));
}

/// Runs the legs in order. Only a leg that is exhausted is followed by the next one.
SearchStatus ContactSearch::run_legs(Search::Limits limits) {
  put_screws_first();
  const double begin = now_.stats.cost;
  const std::uint64_t pause_after = limits.pause_after;
  while (!legs_.empty()) {
    const SearchStatus status = run_leg(legs_.front(), limits);
    if (status != SearchStatus::exhausted) return status;
    legs_.erase(legs_.begin());
    ended_ = now_;
    limits.pause_after = rest_of_pause(pause_after, static_cast<std::uint64_t>(now_.stats.cost - begin));
    any_ = true;
    // A part that cannot translate may still rotate, which the first level does not search.
    if (legs_.empty() && tactics_.motion == Motion::automatic && query_.budget.max_depth == 1 &&
        query_.goal.any_of.empty())
      now_.fail(Outcome::depth_limit);
  }
  return status_of(now_.outcome());
}

void ContactSearch::begin_leg(const Leg& leg, Search search) {
  if (leg.space == MotionSpace::rigid && reached_->rigid) search.resume(*reached_->rigid);  // tree of the screw leg
  current_.emplace(std::move(search));
  if (leg.share) share_left_ = share_ = *leg.share - std::min(current_->spared(), *leg.share / 2);
}

/// A leg that ends because its share is used up can be resumed. Work saved by resuming counts, up to half of the share.
/// `exhausted`: the next leg follows.
SearchStatus ContactSearch::run_leg(const Leg& leg, Search::Limits limits) {
  if (!current_) begin_leg(leg, begun(query_, leg.space, tactics_, context_));
  limits.rank = leg.rank;
  limits.expansions = leg.expansions;
  std::uint64_t* const all = limits.steps_left;
  const std::uint64_t left = all != nullptr ? *all : ~std::uint64_t{0};
  const std::uint64_t most = std::min(left, share_left_);
  std::uint64_t own = most;
  if (leg.share) limits.steps_left = &own;
  PathResult result = current_->run(limits);
  if (leg.share) {
    share_left_ -= most - own;
    if (all != nullptr) *all -= most - own;
  }
  const bool paused = current_->paused();
  if (leg.share && result.outcome() == Outcome::timeout && own == 0 && most < left) result.fail(Outcome::depth_limit);
  now_ = any_ ? merged(ended_, std::move(result)) : std::move(result);
  if (paused) return SearchStatus::paused;
  const SearchStatus status = status_of(now_.outcome());
  if (status == SearchStatus::exhausted) keep_tree();
  if (status == SearchStatus::exhausted) current_.reset();
  return status;
}

/// Keeps the tree of the current leg.
void ContactSearch::keep_tree() {
  if (!current_) return;
  if (reached_.use_count() > 1) reached_ = std::make_shared<Reached>(*reached_);  // results must not change afterwards
  (legs_.front().space == MotionSpace::translation ? reached_->translation : reached_->rigid) = current_->tree();
}

PathResult ContactSearch::result() {
  PathResult result = now_;
  if (!ended_without_path(result) && result.outcome() != Outcome::timeout) return result;
  if (!turns_) keep_tree();
  result.state = turns_ ? turns_->reached() : reached_;
  return result;
}

std::unique_ptr<PathSearch> start(const PathQuery& query, const Tactics& tactics, RunContext& context,
                                  std::function<void()> between) {
  if (!fits(query))
    return path::unsupported(
        "pushing needs a simulator with dynamics and "
        "contacts for all moving parts");
  return std::make_unique<ContactSearch>(query, tactics, context, std::move(between));
}

}  // namespace dismantle::push
