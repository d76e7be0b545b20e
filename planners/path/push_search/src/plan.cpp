#include "dismantle/push/plan.h"

#include <algorithm>
#include <utility>

namespace dismantle::push {
namespace {

constexpr std::uint64_t kStepsPerLevel = 2000;  // of a depth limit: simulated, translating as well as turning

/// The result of the later search, with what the earlier one has counted and touched.
PathResult merged(const PathResult& earlier, PathResult later) {
  later.stats += earlier.stats;
  for (const PartId part : earlier.blocked_by)
    if (std::find(later.blocked_by.begin(), later.blocked_by.end(), part) == later.blocked_by.end())
      later.blocked_by.push_back(part);
  if (later.message.empty() && later.outcome() != Outcome::solved) later.message = earlier.message;
  return later;
}

/// What an earlier search in that space has reached; null where there was none.
const Tree* reached_in(const PathQuery& query, MotionSpace space) {
  const auto* reached = dynamic_cast<const Reached*>(query.resume_from);
  if (reached == nullptr) return nullptr;
  const std::optional<Tree>& tree = space == MotionSpace::translation ? reached->translation : reached->rigid;
  return tree ? &*tree : nullptr;
}

Search begun(const PathQuery& query, MotionSpace space, const Tactics& tactics, RunContext& context) {
  Search search(query, space, tactics, context);
  if (const Tree* tree = reached_in(query, space)) search.resume(*tree);
  return search;
}

bool in_vain(const PathResult& result) {
  return result.outcome() == Outcome::exhausted || result.outcome() == Outcome::depth_limit;
}

/// One search after the other, the first that finds something ending it.
class OneByOne {
 public:
  OneByOne(const PathQuery& query, const Tactics& tactics, RunContext& context)
      : query_(query), tactics_(tactics), context_(context) {}

  /// With a part of the steps that are left: `share`, or all. What ends because it has had that part may go on another
  /// time. The work that an earlier search has spared counts, up to a half. True: on to the next.
  bool run(MotionSpace space, Search::Limits limits, std::optional<std::uint64_t> share) {
    Search search = begun(query_, space, tactics_, context_);
    const std::uint64_t left = limits.steps_left != nullptr ? *limits.steps_left : ~std::uint64_t{0};
    if (share) *share -= std::min(search.spared(), *share / 2);
    const std::uint64_t most = share ? std::min(left, *share) : left;
    std::uint64_t own = most;
    std::uint64_t* const all = share ? std::exchange(limits.steps_left, &own) : nullptr;
    PathResult result = search.run(limits);
    if (all != nullptr) *all -= most - own;
    if (share && result.outcome() == Outcome::timeout && own == 0 && most < left) result.fail(Outcome::depth_limit);
    if (!is_success(result.outcome()))
      (space == MotionSpace::translation ? reached_->translation : reached_->rigid) = search.tree();
    result_ = any_ ? merged(result_, std::move(result)) : std::move(result);
    any_ = true;
    return in_vain(result_);
  }

  PathResult result() {
    if (in_vain(result_) || result_.outcome() == Outcome::timeout) result_.state = reached_;
    return result_;
  }
  PathResult result(Outcome instead) {
    result_.fail(instead);
    return result();
  }

 private:
  const PathQuery& query_;
  const Tactics& tactics_;
  RunContext& context_;
  bool any_ = false;
  PathResult result_;
  std::shared_ptr<Reached> reached_ = std::make_shared<Reached>();
};

/// Under a depth limit somebody asks for all parts in turn: most of them are blocked, and have to be found so soon. A
/// part that slides or turns in its play can do so for long, so simulated steps are limited, too.
PathResult up_to_depth(const PathQuery& query, const Tactics& tactics, unsigned depth, Search::Limits limits,
                       RunContext& context) {
  OneByOne searches(query, tactics, context);
  const auto level = static_cast<std::uint64_t>(depth);
  limits.rank = depth;  // the first level: what the contacts leave free, and the axes
  limits.expansions = static_cast<std::uint64_t>(tactics.translation_nodes) * level;
  if (!searches.run(MotionSpace::translation, limits, kStepsPerLevel * level)) return searches.result();
  if (depth == 1) return searches.result(Outcome::depth_limit);  // what cannot move may still be turned
  limits.expansions = static_cast<std::uint64_t>(tactics.rotation_nodes) * level;
  searches.run(MotionSpace::rigid, limits, kStepsPerLevel * level);
  return searches.result();
}

/// Likewise where each part moves in its own way. A state has many more actions then, so it is simulated steps that are
/// counted, and somebody mostly turns, so that is looked at from the first level on.
PathResult each_its_way(const PathQuery& query, const Tactics& tactics, unsigned depth, Search::Limits limits,
                        RunContext& context) {
  OneByOne searches(query, tactics, context);
  limits.rank = 1 + depth / 2;  // one driven, and two along one axis; from the second level on across, too
  const std::uint64_t share = static_cast<std::uint64_t>(tactics.steps_at_once) * depth;
  if (searches.run(MotionSpace::translation, limits, share)) searches.run(MotionSpace::rigid, limits, share);
  return searches.result();
}

}  // namespace

Capabilities required() { return {.dynamics = true, .contacts = true, .distance = false, .max_moving = 1}; }

bool supported(const PathQuery& query) {
  const Capabilities has = query.simulator.capabilities();
  return has.dynamics && has.contacts && has.max_moving >= query.cast.moving.size();
}

void ByTurns::go_on() {
  for (PathResult* result : {&first_, &second_})
    if (result->outcome() == Outcome::timeout) result->fail(Outcome::depth_limit);
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
  paused_ = false;
  Search::Limits turn = limits;
  while (goes_on(first_) || goes_on(second_)) {
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

PathResult plan(const PathQuery& query, const Tactics& tactics, RunContext& context,
                const std::function<void()>& between) {
  if (!supported(query))
    return PathResult::failure(Outcome::unsupported,
                               "pushing needs a simulator with dynamics and contacts for all moving parts");
  std::uint64_t steps_left = query.budget.max_steps;
  Search::Limits limits;
  limits.deadline = query.budget.timeout > 0 ? Deadline::after_seconds(query.budget.timeout) : Deadline();
  limits.steps_left = query.budget.max_steps > 0 ? &steps_left : nullptr;
  limits.between = between;
  const unsigned depth = query.budget.max_depth;
  if (tactics.motion != Motion::automatic) {
    OneByOne search(query, tactics, context);
    search.run(tactics.motion == Motion::translation ? MotionSpace::translation : MotionSpace::rigid, limits, {});
    return search.result();
  }
  if (depth > 0 && !query.goal.any_of.empty()) return each_its_way(query, tactics, depth, limits, context);
  if (depth > 0) return up_to_depth(query, tactics, depth, limits, context);
  ByTurns turns(query, tactics, context);
  PathResult result = turns.run(limits);
  if (in_vain(result) || result.outcome() == Outcome::timeout) result.state = turns.reached();
  return result;
}

}  // namespace dismantle::push
