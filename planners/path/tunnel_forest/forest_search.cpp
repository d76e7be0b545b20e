#include "growth.h"

#include <algorithm>

#include "dismantle/path/growing_turns.h"
#include "dismantle/path/time_limit.h"
#include "dismantle/path/touched.h"

namespace dismantle::tunnel_forest {
namespace {

/// Simulated steps of the first turn of a forest where two grow in turn.
constexpr std::uint64_t kFirstTurn = 10'000;
/// A forest that has seen more of its space by this share in a turn gets twice as long a next one.
constexpr double kFruitful = 1.2;
/// After so many turns in a row without anything new a forest has seen all that it will.
constexpr unsigned kBarren = 3;

}  // namespace

Growth::Growth(const Parameters& parameters, const PathQuery& query, RunContext& context, std::uint64_t most_steps)
    : parameters_(parameters),
      query_(query),
      context_(context),
      deadline_(path::deadline_of(query, context)),
      most_steps_(most_steps) {
  if (parameters_.motion != Motion::rotation) add(MotionSpace::translation, 1);
  if (parameters_.motion != Motion::translation) add(MotionSpace::rigid, 2);
}

void Growth::add(MotionSpace motion, std::uint64_t stream) {
  forests_.push_back(
      {std::make_unique<Forest>(query_, motion, parameters_, context_.rng.fork(stream), [this] { return halted(); }),
       kFirstTurn});
}

SearchStatus Growth::run(const Budget& portion) {
  if (is_success(result_.outcome())) return SearchStatus::solved;
  if (forests_.front().forest->starts_out()) {
    result_.start_is_goal();
    return SearchStatus::solved;
  }
  portion_.last_step = path::end_of_portion(used(), portion.max_steps, most_steps_);
  portion_.deadline = path::deadline_of(portion);
  bool solved = false;
  while (!solved && !over() && !portion_over()) {
    Grown& grown = forests_[current_];
    if (grown.barren < kBarren && (solved = continue_turn(grown), turn_)) continue;
    current_ = (current_ + 1) % forests_.size();
  }
  if (solved) return SearchStatus::solved;
  result_.fail(context_.cancel.cancelled() ? Outcome::cancelled
               : stopped()                 ? Outcome::timeout
               : given_up()                ? Outcome::exhausted
                                           : Outcome::depth_limit);
  return over() || used() >= most_steps_ ? status_of(result_.outcome()) : SearchStatus::paused;
}

/// Stops at the end of the turn or of the portion. The end of a portion does not cut an extension and does not end the
/// turn, so that the length of the portions has no influence on the trees.
bool Growth::continue_turn(Grown& grown) {
  if (!turn_) turn_ = Turn{used(), 0};
  const std::uint64_t end = turn_->begin + grown.turn;
  const auto stop = [&] { return used() >= end || used() >= most_steps_ || stopped(); };
  bool solved = false;
  // Extensions that use no step, as where nothing can move, need a count of their own.
  while (!solved && !stop() && !given_up() && turn_->extensions < grown.turn) {
    if (portion_over()) return false;
    solved = grown.forest->iterate(result_, stop);
    ++turn_->extensions;
  }
  const std::size_t cells = grown.forest->cells();
  const bool whole = used() >= end || turn_->extensions == grown.turn;
  if (cells != grown.cells)
    grown.barren = 0;
  else if (whole)
    ++grown.barren;
  if (static_cast<double>(cells) > kFruitful * static_cast<double>(grown.cells)) grown.turn *= 2;
  grown.cells = cells;
  if (!grown.relaxed) grown.forest->allow_overlap_everywhere();
  grown.relaxed = true;
  turn_.reset();
  return solved;
}

bool Growth::portion_over() const { return used() >= portion_.last_step || portion_.deadline.passed(); }

std::uint64_t Growth::used() const {
  std::uint64_t steps = 0;
  for (const auto& g : forests_) steps += g.forest->steps();
  return steps;
}

bool Growth::halted() const { return context_.cancel.cancelled() || deadline_.passed(); }

bool Growth::stopped() const { return halted() || (query_.budget.max_steps > 0 && used() >= query_.budget.max_steps); }

bool Growth::given_up() const {
  return std::any_of(forests_.begin(), forests_.end(),
                     [&](const Grown& g) {
                       return g.forest->refused() >= static_cast<std::uint64_t>(parameters_.max_refusals);
                     }) ||
         std::all_of(forests_.begin(), forests_.end(), [](const Grown& g) { return g.barren >= kBarren; });
}

PathResult Growth::result() {
  PathResult result = result_;
  if (result.outcome() == Outcome::start_is_goal) return result;
  if (!is_success(result.outcome())) {
    const auto& best = *std::max_element(forests_.begin(), forests_.end(), [](const Grown& a, const Grown& b) {
      return a.forest->farthest_way() < b.forest->farthest_way();
    });
    result.best_pose = best.forest->farthest();
  }
  std::map<PartId, std::uint64_t> touched;
  for (const auto& g : forests_) {
    result.stats += {.steps = g.forest->steps(),
                     .state_checks = g.forest->looks(),
                     .nodes = g.forest->size(),
                     .refused = g.forest->refused(),
                     .cost = static_cast<double>(g.forest->steps() + g.forest->looks()),
                     .extra = {{"tunnels", static_cast<double>(g.forest->tunnels())}}};
    for (const auto& [part, times] : g.forest->touched()) touched[part] += times;
  }
  result.blocked_by = path::most_touched(touched, query_.scene.moving);
  return result;
}

}  // namespace dismantle::tunnel_forest
