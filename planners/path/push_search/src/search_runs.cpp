// Runs from one state with one action.
#include <algorithm>
#include <cstdint>
#include <numbers>
#include <utility>

#include "dismantle/push_search/screw_run.h"
#include "dismantle/push_search/search.h"

namespace dismantle::push {
namespace {

/// Whether a run with rotation has come back to a known state.
///
/// The start and the other states of the run count as known only after the run has left them. They have to count,
/// because otherwise a freely rotating part would never stop.
class Recurrence {
 public:
  /// `leans`: the part is pressed against a wall and passes close to states that are known already, so its run goes on
  /// for one rotation at most. `tree` outlives this.
  Recurrence(const StateTree& tree, const State& start, bool leans)
      : tree_(tree), start_(start), leans_(leans), first_(tree.size()), left_behind_(first_) {}

  /// The state after a planning time step, in which a part has rotated by `angle` at most. `coupled`: parts
  /// that move independently have moved. Such a motion may be the only way out, and it begins among states to which
  /// single parts have moved in their play: it goes on past those, for two rotations at most, until a state of another
  /// run is nearly equal.
  bool at_known(const State& state, double angle, bool coupled) {
    const path::StateSet& known = leans_ || coupled ? tree_.fine() : tree_.seen();
    rotated_ += angle;
    left_start_ = left_start_ || !known.similar(state, start_);
    if (leans_ || coupled)
      return rotated_ > (coupled ? 4 : 2) * std::numbers::pi ||
             (left_start_ && known.has_similar(state, first_, tree_.size()));
    while (left_behind_ < tree_.size() && !known.similar(state, tree_[static_cast<std::int32_t>(left_behind_)].state))
      ++left_behind_;
    return left_start_ && known.has_similar(state, left_behind_, tree_.size());
  }

 private:
  const StateTree& tree_;
  const State start_;
  const bool leans_;
  const std::uint32_t first_;  ///< the first node of the run
  std::uint32_t left_behind_;  ///< the run has moved away from its states before this one
  bool left_start_ = false;
  double rotated_ = 0;
};

}  // namespace

/// Applies one action from a node until the part is separated, stops, or (with rotation) is similar to a known state.
RunEnd Search::follow(std::int32_t from, const Action& action, Stage stage, unsigned depth, PathResult& result) {
  const bool rotates = problem_->rotates(), leans = rotates && stage == Stage::leaning;
  State state = tree_[from].state;
  Recurrence recurrence(tree_, state, leans);
  std::int32_t last = from;
  Path motion;  // since `last`
  while (true) {
    if (work_.used_up()) return RunEnd::stop;
    const std::size_t before = motion.size();
    const State was = state;
    const StepReport report = problem_->world->advance(state, action, problem_->tactics.time_step, &motion);
    work_.count_steps(report.steps);
    if (!report.finite) return RunEnd::blocked;
    if (motion.size() > before && problem_->out(state))
      return verify(tree_.add(last, depth, state, std::move(motion), false), from, result);
    const bool coupled = rotates && problem_->moved_relatively(was, state);
    double angle = 0;
    for (std::size_t i = 0; i < state.bodies.size(); ++i)
      angle = std::max(angle, angle_between(was.bodies[i].pose.q, state.bodies[i].pose.q));
    if (report.stalled || (rotates && recurrence.at_known(state, angle, coupled))) break;
    // All have left together, held by each other alone: the run would never end, nor would those from here.
    if (problem_->independent() && problem_->world->separated(state)) return RunEnd::blocked;
    if ((leans || coupled) && tree_.seen().has_similar(state)) continue;
    const bool keeps_middles = problem_->tactics.intermediate > 0;
    if (rotates) {
      last = tree_.add(last, depth, state, std::exchange(motion, {}), keeps_middles);
      if (keeps_middles) tree_.enqueue(last);
    } else {
      tree_.keep_middle(from, depth, state, motion);
    }
  }
  return end_run(state, from, last, std::move(motion), stage, depth);
}

/// Adds the state where a run ended, unless it is known.
RunEnd Search::end_run(const State& state, std::int32_t from, std::int32_t last, Path motion, Stage stage,
                       unsigned depth) {
  const std::vector<PartId> touched = count_touched(state);
  if (tree_.fine().similar(state, tree_[last].state)) {
    // No progress since the last recorded state, which therefore is the end of the run.
    tree_.note_touched(last, touched);
    if (last != from) tree_.end_run_at(last);
    return RunEnd::blocked;
  }
  const path::StateSet& known = stage == Stage::diagonals ? tree_.seen() : tree_.fine();
  if (known.has_similar(state)) return RunEnd::blocked;
  const std::int32_t end = tree_.add(last, depth, state, std::move(motion), false);
  tree_.note_touched(end, touched);
  tree_.enqueue(end);
  return RunEnd::blocked;
}

/// Follows a screw by geometry, and simulates the rest with a wrench that rotates with the part.
RunEnd Search::follow_screw(std::int32_t from, const geometry::Twist& screw, unsigned depth, PathResult& result) {
  ScrewRun run(*problem_, work_, tree_, from, depth, short_glides_);
  switch (run.follow(screw)) {
    case ScrewRun::End::stop:
      return RunEnd::stop;
    case ScrewRun::End::known:
      return RunEnd::blocked;
    case ScrewRun::End::blocked:
      return follow(run.last(), run.onward(), Stage::twists, depth, result);
    case ScrewRun::End::out:
      break;
  }
  const RunEnd end = verify(run.last(), from, result);
  if (end == RunEnd::refused || end == RunEnd::refused_learned) short_glides_ = true;
  return end;
}

}  // namespace dismantle::push
