#include "forest_search.h"

#include <algorithm>

#include "dismantle/path/touched.h"
#include "dismantle/search/growing_turns.h"
#include "dismantle/search/time_limit.h"

namespace dismantle::tunnel_forest {

ForestSearch::ForestSearch(const Parameters& parameters, const PathQuery& query, RunContext& context,
                           std::uint64_t most_steps)
    : parameters_(parameters),
      query_(query),
      context_(context),
      deadline_(path::deadline_of(query, context)),
      most_steps_(most_steps) {
  if (parameters_.motion != Motion::rotation) add(MotionSpace::translation, 1);
  if (parameters_.motion != Motion::translation) add(MotionSpace::rigid, 2);
}

void ForestSearch::add(MotionSpace motion, std::uint64_t stream) {
  forests_.push_back(
      {std::make_unique<Forest>(query_, motion, parameters_, context_.rng.fork(stream), [this] { return halted(); }),
       static_cast<std::uint64_t>(parameters_.first_turn)});
}

SearchStatus ForestSearch::run(const Budget& portion) {
  if (is_success(result_.outcome())) return SearchStatus::solved;
  if (forests_.front().forest->starts_separated()) {
    result_.start_is_goal();
    return SearchStatus::solved;
  }
  portion_.last_step = path::end_of_portion(used(), portion.max_steps, most_steps_);
  portion_.deadline = path::deadline_of(portion);
  bool solved = false;
  while (!solved && !over() && !portion_over()) {
    GrowingForest& growing = forests_[current_];
    if (growing.barren_turns < parameters_.barren_turns && (solved = continue_turn(growing), turn_)) continue;
    current_ = (current_ + 1) % forests_.size();
  }
  if (solved) return SearchStatus::solved;
  result_.fail(context_.cancel.cancelled() ? Outcome::cancelled
               : stopped()                 ? Outcome::timeout
               : given_up()                ? Outcome::exhausted
                                           : Outcome::depth_limit);
  return over() || used() >= most_steps_ ? status_of(result_.outcome()) : SearchStatus::paused;
}

/// Stops at the end of the turn or of the portion. The end of a portion neither interrupts an extension nor ends the
/// turn, so the lengths of portions do not change the trees.
bool ForestSearch::continue_turn(GrowingForest& growing) {
  if (!turn_) turn_ = Turn{used(), 0};
  const std::uint64_t end = turn_->begin + growing.turn;
  const auto stop = [&] { return used() >= end || used() >= most_steps_ || stopped(); };
  bool solved = false;
  // If nothing can move, extensions take no time steps, so their number is limited as well.
  while (!solved && !stop() && !given_up() && turn_->extensions < growing.turn) {
    if (portion_over()) return false;
    solved = growing.forest->iterate(result_, stop);
    ++turn_->extensions;
  }
  const std::size_t cells = growing.forest->cells();
  const bool whole = used() >= end || turn_->extensions == growing.turn;
  if (cells != growing.cells)
    growing.barren_turns = 0;
  else if (whole)
    ++growing.barren_turns;
  if (static_cast<double>(cells) > (1 + parameters_.new_cells) * static_cast<double>(growing.cells)) growing.turn *= 2;
  growing.cells = cells;
  if (!growing.overlap_everywhere) growing.forest->allow_overlap_everywhere();
  growing.overlap_everywhere = true;
  turn_.reset();
  return solved;
}

bool ForestSearch::portion_over() const { return used() >= portion_.last_step || portion_.deadline.passed(); }

std::uint64_t ForestSearch::used() const {
  std::uint64_t steps = 0;
  for (const auto& g : forests_) steps += g.forest->steps();
  return steps;
}

bool ForestSearch::halted() const { return context_.cancel.cancelled() || deadline_.passed(); }

bool ForestSearch::stopped() const {
  return halted() || (query_.budget.max_steps > 0 && used() >= query_.budget.max_steps);
}

bool ForestSearch::given_up() const {
  return std::any_of(forests_.begin(), forests_.end(),
                     [&](const GrowingForest& g) {
                       return g.forest->refused() >= static_cast<std::uint64_t>(parameters_.max_refusals);
                     }) ||
         std::all_of(forests_.begin(), forests_.end(),
                     [&](const GrowingForest& g) { return g.barren_turns >= parameters_.barren_turns; });
}

PathResult ForestSearch::result() {
  PathResult result = result_;
  if (result.outcome() == Outcome::start_is_goal) return result;
  if (!is_success(result.outcome())) {
    const auto& best =
        *std::max_element(forests_.begin(), forests_.end(), [](const GrowingForest& a, const GrowingForest& b) {
          return a.forest->farthest_distance() < b.forest->farthest_distance();
        });
    result.best_pose = best.forest->farthest();
  }
  std::map<PartId, std::uint64_t> touched;
  for (const auto& g : forests_) {
    result.stats += {.steps = g.forest->steps(),
                     .state_checks = g.forest->state_checks(),
                     .nodes = g.forest->size(),
                     .refused = g.forest->refused(),
                     .cost = static_cast<double>(g.forest->steps() + g.forest->state_checks()),
                     .extra = {{"tunnels", static_cast<double>(g.forest->tunnels())}}};
    for (const auto& [part, times] : g.forest->touched()) touched[part] += times;
  }
  result.blocked_by = path::most_touched(touched, query_.scene.moving);
  return result;
}

}  // namespace dismantle::tunnel_forest
