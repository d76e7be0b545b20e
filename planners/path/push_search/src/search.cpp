#include "dismantle/push/search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "dismantle/geometry/numerics.h"
#include "dismantle/path/candidates.h"
#include "dismantle/path/placed_parts.h"
#include "dismantle/path/touched.h"

namespace dismantle::push {
namespace {

bool same_path(const Path& a, const Path& b) {
  const double same = std::sqrt(geometry::kRounding);  // repeated simulations differ by rounding only
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k)
    for (std::size_t i = 0; i < a[k].size(); ++i)
      if ((a[k][i].t - b[k][i].t).norm() > same || angle_between(a[k][i].q, b[k][i].q) > same) return false;
  return true;
}

}  // namespace

Search::Search(const PathQuery& query, MotionSpace space, const Tactics& tactics, RunContext& context)
    : query_(query),
      tactics_(tactics),
      context_(context),
      world_(query.simulator.world(query.assembly, query.prepared, query.scene, space)),
      bodies_(path::balls_of(*world_)),
      axes_(tactics.own_axes ? own_axes(query.assembly, query.scene, tactics.facet_angle)
                             : Eigen::Matrix3d::Identity()),
      extents_(query.assembly, query.scene, axes_),
      stages_(!query.goal.any_of.empty()          ? tactics.each_its_way
              : space == MotionSpace::translation ? tactics.translating
                                                  : tactics.turning),
      seen_(bodies_, tactics.similarity_translation, tactics.similarity_rotation),
      fine_(bodies_, tactics.end_similarity * tactics.similarity_translation,
            tactics.end_similarity * tactics.similarity_rotation),
      places_(bodies_, tactics.place_similarity * tactics.similarity_translation, tactics.similarity_rotation) {}

void Search::clear() {
  for (path::StateSet* states : {&seen_, &fine_, &places_}) states->clear();
  nodes_.clear();
  waiting_.clear();
  beyond_limit_ = 0;
  passed_.clear();
  passed_before_ = 0;
  expanded_before_ += expanded_;
  expanded_ = 0;
  spared_ = kept_ = resumed_ = 0;
}

void Search::reset() {
  clear();
  enqueue(add_node(-1, 0, world_->initial_state(), {}, false));
}

std::int32_t Search::add_node(std::int32_t parent, unsigned depth, const State& state, Path way, bool middle) {
  Node node{state, parent, depth, std::move(way), 0, middle, false, {}, 0};
  for (auto& b : node.state.bodies) b.velocity.setZero(), b.angular_velocity.setZero();
  const auto id = static_cast<std::int32_t>(nodes_.size());
  seen_.add(node.state, static_cast<std::uint32_t>(id));
  fine_.add(node.state, static_cast<std::uint32_t>(id));
  if (const double from_start = way_from_start(state); from_start > farthest_) {
    farthest_ = from_start;
    best_ = path::poses_of(state);
  }
  nodes_.push_back(std::move(node));
  return id;
}

unsigned Search::rank(const Node& node) const {
  const auto lag = static_cast<unsigned>(tactics_.middle_lag);
  unsigned stage = static_cast<unsigned>(node.stage) + (node.middle ? lag : 0);
  // Other queries search for motions of a single part.
  if (!query_.goal.any_of.empty() && node.parent >= 0 && way_from_start(node.state) < tactics_.similarity_translation)
    stage += lag;
  if (!tactics_.novelty) return stage;
  const auto near = static_cast<unsigned>(places_.count_similar(node.state));
  // `near` includes the state itself once it has been expanded.
  return stage + near - (node.stage > 0 && near > 0 ? 1 : 0);
}

void Search::enqueue(std::int32_t id) {
  Node& node = nodes_[static_cast<std::size_t>(id)];
  node.may_wait = true;
  if (query_.budget.max_depth > 0 && node.depth >= query_.budget.max_depth) {
    ++beyond_limit_;
    return;
  }
  waiting_.insert({rank(node), node.depth, id});
}

Path Search::path_to(std::int32_t node) const {
  std::vector<const Path*> pieces;
  std::int32_t at = node;
  for (; nodes_[static_cast<std::size_t>(at)].parent >= 0; at = nodes_[static_cast<std::size_t>(at)].parent)
    pieces.push_back(&nodes_[static_cast<std::size_t>(at)].way);
  Path path{path::poses_of(nodes_[static_cast<std::size_t>(at)].state)};
  for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece)
    path.insert(path.end(), (*piece)->begin(), (*piece)->end());
  return path;
}

/// The fixed parts that the moving parts touch in this state; counts them.
std::vector<PartId> Search::note_contacts(const State& state) {
  std::vector<Contact> contacts;
  world_->contacts(state, contacts);
  std::vector<PartId> parts = path::touched_parts(contacts, query_.scene.moving, query_.tolerance);
  for (PartId p : parts) ++touched_[p];
  return parts;
}

void Search::note_touched(std::int32_t node, const std::vector<PartId>& parts) {
  std::vector<PartId>& all = nodes_[static_cast<std::size_t>(node)].touched;
  std::vector<PartId> both;
  std::set_union(all.begin(), all.end(), parts.begin(), parts.end(), std::back_inserter(both));
  all = std::move(both);
}

bool Search::out_of_budget() const {
  return (limits_.steps_left != nullptr && *limits_.steps_left == 0) || context_.should_stop() ||
         limits_.deadline.passed();
}

/// Checks the path to node `last`, where the part is separated.
Search::RunEnd Search::verify(std::int32_t last, const State& start, PathResult& result) {
  Path path = path::thin(path_to(last), bodies_, tactics_.thinning);
  for (const Path& refused : refusals_)
    if (same_path(refused, path)) return RunEnd::blocked;  // the world could not learn from the earlier refusal
  std::uint64_t refused_forms = 0;
  PathCheck first;
  const auto form = [&](std::size_t k) -> std::optional<Path> {
    if (k == 0) return path;
    return k == 1 && !query_.goal.any_of.empty() ? std::optional(with_room(path)) : std::nullopt;
  };
  const auto learn = [&](const PathCheck& check, const Path&) {
    if (refused_forms == 1) first = check;  // the second form is not the path of these states any more
    return true;
  };
  const auto accept = [&](VerifiedPath verified) {
    note_contacts(start);
    result.solve(std::move(verified), nodes_[static_cast<std::size_t>(last)].depth);
  };
  if (path::show_forms(query_.checker, refused_forms, form, learn, accept).accepted) return RunEnd::solved;
  ++refused_;
  refusals_.push_back(std::move(path));
  result.message = first.reason;
  if (!first.has_witness) return RunEnd::refused;
  world_->add_contact_sample(first.part, first.other, first.point);
  samples_.push_back({first.part, first.other, first.point});
  return RunEnd::refused_learned;
}

/// Applies one action from a node until the part is separated, stops, or (turning) is similar to a known state.
Search::RunEnd Search::follow(std::int32_t from, const Action& action, Stage stage, unsigned depth,
                              PathResult& result) {
  const auto first_of_run = static_cast<std::uint32_t>(nodes_.size());
  // A leaning part passes close to states that are known already: its run continues, but for one turn at most.
  const bool leans = turning() && stage == Stage::leaning;
  const path::StateSet& known = leans ? fine_ : seen_;
  double turned = 0;
  State state = nodes_[static_cast<std::size_t>(from)].state;
  const State start = state;
  std::int32_t last = from;
  bool left_start = false;
  std::uint32_t left_behind = first_of_run;  // the run has moved away from its states before this one
  Path way;                                  // since `last`
  while (true) {
    if (out_of_budget()) return RunEnd::stop;
    const std::size_t before = way.size();
    const Eigen::Quaterniond was = state.bodies[0].pose.q;
    const StepReport report = world_->advance(state, action, tactics_.time_step, &way);
    turned += angle_between(was, state.bodies[0].pose.q);
    steps_ += report.steps;
    if (limits_.steps_left != nullptr) *limits_.steps_left -= std::min(*limits_.steps_left, report.steps);
    if (!report.finite) return RunEnd::blocked;
    if (way.size() > before && out(state))
      return verify(add_node(last, depth, state, std::move(way), false), start, result);
    bool ended = report.stalled;
    if (turning()) {
      // The start and the other states of the run count as known only after the run has left them. They have to count,
      // because otherwise a freely rotating part would never stop.
      const auto size = static_cast<std::uint32_t>(nodes_.size());
      left_start = left_start || !known.similar(state, start);
      if (leans) {
        ended = ended || turned > 2 * std::numbers::pi || (left_start && known.has_similar(state, first_of_run, size));
      } else {
        while (left_behind < size && !known.similar(state, nodes_[left_behind].state)) ++left_behind;
        ended = ended || (left_start && known.has_similar(state, left_behind, size));
      }
    }
    if (ended) break;
    if (leans && seen_.has_similar(state)) continue;
    if (turning()) {
      last = add_node(last, depth, state, std::move(way), tactics_.intermediate > 0);
      way.clear();
      if (tactics_.intermediate > 0) enqueue(last);
    } else if (passed_before_ + passed_.size() < static_cast<std::size_t>(tactics_.intermediate)) {
      passed_.push_back({from, depth, state, way});
    }
  }
  const std::vector<PartId> touched = note_contacts(state);
  if (fine_.similar(state, nodes_[static_cast<std::size_t>(last)].state)) {
    // No progress since the last recorded state, which therefore is the end of the run.
    note_touched(last, touched);
    if (last == from) return RunEnd::blocked;
    Node& end = nodes_[static_cast<std::size_t>(last)];
    if (end.middle) std::erase_if(waiting_, [last](const Waiting& w) { return w.node == last; });
    end.middle = false;
    enqueue(last);
    return RunEnd::blocked;
  }
  const bool is_known = stage == Stage::diagonals ? seen_.has_similar(state) : fine_.has_similar(state);
  if (is_known) return RunEnd::blocked;
  last = add_node(last, depth, state, std::move(way), false);
  note_touched(last, touched);
  enqueue(last);
  return RunEnd::blocked;
}

void Search::finish(PathResult& result) const {
  result.stats = {.steps = steps_,
                  .state_checks = state_checks_,
                  .nodes = nodes_.size(),
                  .refused = refused_,
                  .resumed_nodes = resumed_,
                  .spared = spared_,
                  .cost = static_cast<double>(steps_ + state_checks_),
                  .extra = {{"expanded", static_cast<double>(expanded_before_ + expanded_)}}};
  result.blocked_by = path::most_touched(touched_, query_.scene.moving);
  result.best_pose = best_;
}

std::vector<Action> Search::actions_at(const Node& node, Stage stage) {
  std::vector<Action> actions;
  switch (stage) {
    case Stage::axes:
      return unit_actions(*world_, tactics_.force, turning(), axes_);
    case Stage::diagonals:
      return diagonal_actions(*world_, tactics_.force, axes_);
    case Stage::screws:
      return screw_actions(*world_, tactics_.force, axes_);
    case Stage::one_driven:
      return one_driven(*world_, tactics_.force, turning(), axes_);
    case Stage::two_along:
    case Stage::two_across:
      return two_driven(*world_, tactics_.force, turning(), axes_, stage == Stage::two_across);
    case Stage::twists:
    case Stage::free:
    case Stage::leaning:
      break;
  }
  if (turning()) return leaning_turns(node);
  std::vector<Contact> contacts;
  world_->contacts(node.state, contacts);
  const Freedom freedom = freedom_of(contacts, query_.scene.moving, extents_, tactics_);
  for (const auto& d : stage == Stage::free ? freedom.directions : leaning(freedom, tactics_.lean))
    actions.push_back(push(*world_, tactics_.force, d));
  return actions;
}

/// Applies the next stage of actions to a state.
Search::RunEnd Search::expand(std::int32_t id, PathResult& result) {
  ++expanded_;
  const std::uint64_t before = steps_ + state_checks_;
  const std::size_t stage = nodes_[static_cast<std::size_t>(id)].stage++;
  if (stage == 0) places_.add(nodes_[static_cast<std::size_t>(id)].state, 0);
  const auto over = [&](RunEnd end) {
    return end == RunEnd::solved || end == RunEnd::stop || end == RunEnd::refused_learned ||
           refused_ > static_cast<std::uint64_t>(tactics_.max_refusals);
  };
  const unsigned depth = nodes_[static_cast<std::size_t>(id)].depth + 1;
  RunEnd end = RunEnd::blocked;
  if (stages_[stage] == Stage::twists) {
    for (const Twist& twist : twists_at(nodes_[static_cast<std::size_t>(id)]))
      if (over(end = follow_screw(id, twist, depth, result))) break;
  } else {
    for (const Action& action : actions_at(nodes_[static_cast<std::size_t>(id)], stages_[stage]))
      if (over(end = follow(id, action, stages_[stage], depth, result))) break;
  }
  if (end == RunEnd::stop) nodes_[static_cast<std::size_t>(id)].stage = stage;  // a resumed search repeats it
  if (over(end)) return end == RunEnd::blocked ? RunEnd::refused : end;
  nodes_[static_cast<std::size_t>(id)].work += steps_ + state_checks_ - before;
  if (stage + 1 < stages_.size()) enqueue(id);
  return RunEnd::blocked;
}

Search::RunEnd Search::sweep(std::uint64_t expansions, PathResult& result) {
  if (!std::exchange(sweep_paused_, false) || expansions == 0)
    sweep_end_ = expanded_ + expansions - std::min(kept_, expansions / 2);
  while (!waiting_.empty() || take_up_middles()) {
    if (expansions > 0 && expanded_ >= sweep_end_) return RunEnd::blocked;
    paused_ = limits_.pause_after > 0 && steps_ + state_checks_ >= pause_at_;
    sweep_paused_ = paused_ && limits_.expansions > 0;
    if (paused_) return RunEnd::blocked;
    const Waiting next = *waiting_.begin();
    if (next.rank > limits_.rank) return RunEnd::blocked;
    waiting_.erase(waiting_.begin());
    const Node& node = nodes_[static_cast<std::size_t>(next.node)];
    const unsigned now = rank(node);
    if (now > next.rank) {  // similar states have been expanded since
      waiting_.insert({now, next.depth, next.node});
      continue;
    }
    if (limits_.between) limits_.between();
    const RunEnd end = expand(next.node, result);
    if (end != RunEnd::blocked) return end;
  }
  return RunEnd::blocked;
}

/// Called when no state waits: enqueues the states in the middle of runs. False if none of them is new.
bool Search::take_up_middles() {
  passed_before_ += passed_.size();
  for (Middle& m : std::exchange(passed_, {}))
    if (!seen_.has_similar(m.state)) enqueue(add_node(m.from, m.depth, m.state, std::move(m.way), true));
  return !waiting_.empty();
}

PathResult Search::run(const Limits& limits) {
  limits_ = limits;
  pause_at_ = steps_ + state_checks_ + limits.pause_after;
  paused_ = false;
  PathResult result;
  if (nodes_.empty()) reset();
  if (!std::exchange(begun_, true)) {
    if (out(nodes_.front().state)) {
      result.start_is_goal();
      finish(result);
      return result;
    }
  }
  RunEnd end = RunEnd::blocked;
  for (const std::int32_t node : out_by_now()) {
    end = verify(node, nodes_[static_cast<std::size_t>(node)].state, result);
    if (end == RunEnd::refused_learned) reset();
    if (end == RunEnd::refused_learned || end == RunEnd::solved) break;
  }
  while (end != RunEnd::solved) {
    // The number of states is limited, because a part may be able to move far in a strict world, too.
    const auto strict_nodes = static_cast<std::uint64_t>(tactics_.translation_nodes);
    const bool overlapping = may_relax_ && world_->overlap_is_local();
    end = sweep(overlapping ? std::min(limits.expansions - 1, strict_nodes - 1) + 1 : limits.expansions, result);
    if (end == RunEnd::refused_learned && refused_ <= static_cast<std::uint64_t>(tactics_.max_refusals)) {
      reset();  // states found so far may have passed through the same penetration
      continue;
    }
    if (end != RunEnd::blocked || !overlapping || paused_) break;
    world_->allow_overlap_everywhere();
    may_relax_ = false;
    reset();  // the search restarts with the overlap that the verifier allows
  }
  if (end == RunEnd::solved) {
    result.message.clear();
  } else if (end == RunEnd::stop) {
    result.fail(context_.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout);
  } else if (refused_ > static_cast<std::uint64_t>(tactics_.max_refusals)) {
    result.fail(Outcome::exhausted);
  } else {
    result.fail(!waiting_.empty() || beyond_limit_ > 0 ? Outcome::depth_limit : Outcome::exhausted);
  }
  finish(result);
  return result;
}

}  // namespace dismantle::push
