#include "dismantle/push_search/state_tree.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "dismantle/search/placed_parts.h"

namespace dismantle::push {
namespace {

path::StateSet states(const Problem& problem, double share_of_translation, double share_of_rotation) {
  return {problem.bodies, share_of_translation * problem.tactics.similarity_translation,
          share_of_rotation * problem.tactics.similarity_rotation};
}

}  // namespace

StateTree::StateTree(const Problem& problem, const RunContext& context)
    : problem_(problem),
      record_(problem.query, context),
      seen_(states(problem, 1, 1)),
      fine_(states(problem, problem.tactics.end_similarity, problem.tactics.end_similarity)),
      places_(states(problem, problem.tactics.place_similarity, 1)) {}

void StateTree::clear() {
  for (path::StateSet* set : {&seen_, &fine_, &places_}) set->clear();
  nodes_.clear();
  record_.restart();
  waiting_.clear();
  beyond_limit_ = 0;
  middles_.clear();
  middles_before_ = 0;
}

std::int32_t StateTree::add(std::int32_t parent, unsigned depth, const State& state, Path motion, bool middle) {
  Node node{state, parent, depth, std::move(motion), 0, middle, false, {}, 0};
  for (auto& b : node.state.bodies) b.velocity.setZero(), b.angular_velocity.setZero();
  const std::uint32_t id = size();
  seen_.add(node.state, id);
  fine_.add(node.state, id);
  const double displacement = problem_.displacement(state);
  if (record_.listens()) record_.node(parent, path::poses_of(state), static_cast<double>(work_), displacement);
  if (displacement > displacement_) {
    displacement_ = displacement;
    farthest_ = path::poses_of(state);
  }
  nodes_.push_back(std::move(node));
  return static_cast<std::int32_t>(id);
}

unsigned StateTree::rank(const Node& node) const {
  const Tactics& tactics = problem_.tactics;
  const auto lag = static_cast<unsigned>(tactics.middle_lag);
  unsigned stage = static_cast<unsigned>(node.stage) + (node.middle ? lag : 0);
  // Other queries search for motions of a single part.
  if (problem_.independent() && node.parent >= 0 && problem_.displacement(node.state) < tactics.similarity_translation)
    stage += lag;
  if (!tactics.novelty) return stage;
  const auto near = static_cast<unsigned>(places_.count_similar(node.state));
  // `near` includes the state itself once it has been expanded.
  return stage + near - (node.stage > 0 && near > 0 ? 1 : 0);
}

void StateTree::enqueue(std::int32_t id) {
  Node& node = (*this)[id];
  node.may_wait = true;
  const unsigned most = problem_.query.budget.max_depth;
  if (most > 0 && node.depth >= most)
    ++beyond_limit_;
  else
    waiting_.insert({rank(node), node.depth, id});
}

std::optional<std::int32_t> StateTree::take(unsigned most) {
  while (!waiting_.empty() && waiting_.begin()->rank <= most) {
    const Waiting next = *waiting_.begin();
    waiting_.erase(waiting_.begin());
    const unsigned now = rank((*this)[next.node]);
    if (now <= next.rank) return next.node;
    waiting_.insert({now, next.depth, next.node});  // similar states have been expanded since
  }
  return std::nullopt;
}

std::size_t StateTree::begin_stage(std::int32_t id) {
  Node& node = (*this)[id];
  if (node.stage == 0) places_.add(node.state, 0);
  return node.stage++;
}

void StateTree::end_run_at(std::int32_t id) {
  Node& end = (*this)[id];
  if (end.middle) std::erase_if(waiting_, [id](const Waiting& w) { return w.node == id; });
  end.middle = false;
  enqueue(id);
}

void StateTree::note_touched(std::int32_t id, const std::vector<PartId>& parts) {
  std::vector<PartId>& all = (*this)[id].touched;
  std::vector<PartId> both;
  std::set_union(all.begin(), all.end(), parts.begin(), parts.end(), std::back_inserter(both));
  all = std::move(both);
}

void StateTree::keep_middle(std::int32_t from, unsigned depth, const State& state, const Path& motion) {
  if (middles_before_ + middles_.size() < static_cast<std::size_t>(problem_.tactics.intermediate))
    middles_.push_back({from, depth, state, motion});
}

bool StateTree::take_up_middles() {
  middles_before_ += middles_.size();
  for (Middle& m : std::exchange(middles_, {}))
    if (!seen_.has_similar(m.state)) enqueue(add(m.from, m.depth, m.state, std::move(m.motion), true));
  return !waiting_.empty();
}

void StateTree::restore(const Tree& tree, const std::vector<PartId>& absent) {
  clear();
  for (const Node& known : tree.nodes) {
    Node& node = (*this)[add(known.parent, known.depth, known.state, known.motion, known.middle)];
    std::set_difference(known.touched.begin(), known.touched.end(), absent.begin(), absent.end(),
                        std::back_inserter(node.touched));
    const bool freed = node.touched.size() < known.touched.size();
    node.may_wait = known.may_wait || freed;
    if (freed) continue;
    node.stage = known.stage;
    node.work = known.work;
    if (node.stage > 0) places_.add(node.state, 0);
  }
  for (std::size_t id = 0; id < nodes_.size(); ++id)  // ranks depend on all expanded states
    if (nodes_[id].may_wait && nodes_[id].stage < problem_.stages().size()) enqueue(static_cast<std::int32_t>(id));
  middles_ = tree.middles;
  middles_before_ = tree.middles_before;
}

void StateTree::save(Tree& tree) const {
  tree.nodes = nodes_;
  tree.middles = middles_;
  tree.middles_before = middles_before_;
}

Path StateTree::path_to(std::int32_t id) const {
  std::vector<const Node*> line{&(*this)[id]};
  while (line.back()->parent >= 0) line.push_back(&(*this)[line.back()->parent]);
  Path path{path::poses_of(line.back()->state)};
  for (auto node = line.rbegin() + 1; node != line.rend(); ++node)
    path.insert(path.end(), (*node)->motion.begin(), (*node)->motion.end());
  return path;
}

}  // namespace dismantle::push
