#include "dismantle/push_search/search.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "dismantle/path/touched.h"

namespace dismantle::push {

Search::Search(const PathQuery& query, MotionSpace space, const Tactics& tactics, RunContext& context)
    : context_(context),
      problem_(std::make_unique<Problem>(query, space, tactics)),
      tree_(*problem_, context),
      verification_(*problem_),
      work_(context) {
  const auto* reached = dynamic_cast<const Reached*>(query.resume_from);
  if (reached == nullptr) return;
  const std::optional<Tree>& tree = space == MotionSpace::translation ? reached->translation : reached->rigid;
  if (tree) resume(*tree);
}

void Search::clear() {
  tree_.clear();
  expanded_before_ += std::exchange(expanded_, 0);
  resumed_ = {};
}

void Search::restart() {
  clear();
  tree_.enqueue(tree_.add(-1, 0, problem_->world->initial_state(), {}, false));
}

bool Search::needs_screw() const {
  const Tactics& tactics = problem_->tactics;
  const bool follows_screws = !tactics.rotating.empty() && tactics.rotating.front() == Stage::twists;
  return tactics.motion == Motion::automatic && !problem_->independent() && follows_screws &&
         screw_leads_out(*problem_);
}

/// The fixed parts that the moving parts touch in this state.
std::vector<PartId> Search::count_touched(const State& state) {
  std::vector<PartId> parts =
      path::touched_parts(problem_->contacts(state), problem_->query.scene.moving, problem_->query.tolerance);
  for (const PartId p : parts) ++touched_[p];
  return parts;
}

/// Checks the path to node `last`, where the part is separated. The last run began at node `from`.
RunEnd Search::verify(std::int32_t last, std::int32_t from, PathResult& result) {
  const RunEnd end = verification_.show(tree_.path_to(last), tree_[last].depth, work_, result);
  if (end == RunEnd::solved) count_touched(tree_[from].state);
  return end;
}

/// Applies the next stage of actions to a state.
RunEnd Search::expand(std::int32_t id, PathResult& result) {
  ++expanded_;
  const std::uint64_t before = work_.total();
  tree_.note_work(before);
  const std::size_t stage = tree_.begin_stage(id);
  const Stage actions = problem_->stages()[stage];
  const unsigned depth = tree_[id].depth + 1;
  const auto over = [&](RunEnd end) {
    return end == RunEnd::solved || end == RunEnd::stop || end == RunEnd::refused_learned || verification_.too_many();
  };
  RunEnd end = RunEnd::blocked;
  if (actions == Stage::twists) {
    for (const geometry::Twist& screw : proposed_screws(*problem_, work_, tree_[id].state))
      if (over(end = follow_screw(id, screw, depth, result))) break;
  } else {
    for (const Action& action : actions_at(*problem_, work_, tree_[id].state, actions))
      if (over(end = follow(id, action, actions, depth, result))) break;
  }
  if (end == RunEnd::stop) tree_[id].stage = stage;  // a resumed search repeats it
  if (over(end)) return end == RunEnd::blocked ? RunEnd::refused : end;
  tree_[id].work += work_.total() - before;
  if (stage + 1 < problem_->stages().size()) tree_.enqueue(id);
  return RunEnd::blocked;
}

RunEnd Search::sweep(std::uint64_t expansions, PathResult& result) {
  if (!std::exchange(sweep_paused_, false) || expansions == 0)
    sweep_end_ = expanded_ + expansions - std::min(resumed_.expanded, expansions / 2);
  while (tree_.waits() || tree_.take_up_middles()) {
    if (expansions > 0 && expanded_ >= sweep_end_) return RunEnd::blocked;
    paused_ = work_.pauses();
    sweep_paused_ = paused_ && limits_.expansions > 0;
    if (paused_) return RunEnd::blocked;
    const std::optional<std::int32_t> next = tree_.take(limits_.rank);
    if (!next) return RunEnd::blocked;
    if (limits_.between) limits_.between();
    const RunEnd end = expand(*next, result);
    if (end != RunEnd::blocked) return end;
  }
  return RunEnd::blocked;
}

/// Sweeps until there is a path, or no more states. A world that is stricter than the verifier about parts that overlap
/// is relaxed after a short sweep.
RunEnd Search::sweep_all(PathResult& result) {
  while (true) {
    // The number of states is limited, because a part may be able to move far in a strict world, too.
    const auto strict_nodes = static_cast<std::uint64_t>(problem_->tactics.translation_nodes);
    const bool strict = !relaxed_ && problem_->world->overlap_is_local();
    const RunEnd end =
        sweep(strict ? std::min(limits_.expansions - 1, strict_nodes - 1) + 1 : limits_.expansions, result);
    if (end == RunEnd::refused_learned && !verification_.too_many()) {
      restart();  // states found so far may have passed through the same penetration
      continue;
    }
    if (end != RunEnd::blocked || !strict || paused_) return end;
    problem_->world->allow_overlap_everywhere();
    relaxed_ = true;
    restart();  // the search restarts with the overlap that the verifier allows
  }
}

PathResult Search::run(const Limits& limits) {
  limits_ = limits;
  work_.begin(limits);
  paused_ = false;
  PathResult result;
  if (tree_.size() == 0) restart();
  if (!std::exchange(begun_, true) && problem_->out(tree_[0].state)) {
    result.start_is_goal();
    report(result);
    return result;
  }
  RunEnd end = verify_resumed(result);
  if (end != RunEnd::solved) end = sweep_all(result);
  set_outcome(end, result);
  report(result);
  return result;
}

void Search::set_outcome(RunEnd end, PathResult& result) const {
  if (end == RunEnd::solved)
    result.message.clear();
  else if (end == RunEnd::stop)
    result.fail(context_.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout);
  else if (!verification_.too_many() && (tree_.waits() || tree_.depth_limited()))
    result.fail(Outcome::depth_limit);
  else
    result.fail(Outcome::exhausted);
}

void Search::report(PathResult& result) const {
  result.stats = {.steps = work_.steps(),
                  .state_checks = work_.state_checks(),
                  .nodes = tree_.size(),
                  .refused = verification_.refused(),
                  .resumed_nodes = resumed_.nodes,
                  .spared = resumed_.spared,
                  .cost = static_cast<double>(work_.total()),
                  .extra = {{"expanded", static_cast<double>(expanded_before_ + expanded_)}}};
  result.blocked_by = path::most_touched(touched_, problem_->query.scene.moving);
  result.best_pose = tree_.farthest();
}

PathResult merged(const PathResult& earlier, PathResult later) {
  later.stats += earlier.stats;
  for (const PartId part : earlier.blocked_by)
    if (std::find(later.blocked_by.begin(), later.blocked_by.end(), part) == later.blocked_by.end())
      later.blocked_by.push_back(part);
  if (later.message.empty() && later.outcome() != Outcome::solved) later.message = earlier.message;
  return later;
}

}  // namespace dismantle::push
