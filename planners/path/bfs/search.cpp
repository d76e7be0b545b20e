#include "search.h"

#include <algorithm>
#include <cmath>

namespace dismantle::bfs {
namespace {

std::vector<path::Ball> balls(const World& world) {
  std::vector<path::Ball> result;
  for (std::size_t i = 0; i < world.cast().moving.size(); ++i)
    result.push_back({world.center(i), world.space() == MotionSpace::translation ? 0.0 : world.radius(i)});
  return result;
}

/// Stage 0: the paper's unit actions, the same for all moving parts. Stage 1: the diagonals.
std::vector<std::vector<Action>> action_stages(const World& world, const Parameters& p) {
  const std::size_t bodies = world.cast().moving.size();
  const auto push = [&](const Eigen::Vector3d& direction) {
    Action a;
    for (std::size_t i = 0; i < bodies; ++i) a.wrenches.push_back({p.force * direction.normalized(), Eigen::Vector3d::Zero()});
    return a;
  };
  std::vector<std::vector<Action>> stages(1);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) stages[0].push_back(push(sign * Eigen::Vector3d::Unit(axis)));
  if (world.space() == MotionSpace::rigid) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        Action a;
        for (std::size_t i = 0; i < bodies; ++i)
          a.wrenches.push_back({Eigen::Vector3d::Zero(), sign * p.force * world.torque_arm(i) * Eigen::Vector3d::Unit(axis)});
        stages[0].push_back(std::move(a));
      }
  } else if (p.diagonals) {
    stages.emplace_back();
    for (int weight = 3; weight >= 2; --weight)  // space diagonals first: they reach all three axes
      for (int x = 1; x >= -1; --x)
        for (int y = 1; y >= -1; --y)
          for (int z = 1; z >= -1; --z)
            if (std::abs(x) + std::abs(y) + std::abs(z) == weight) stages[1].push_back(push(Eigen::Vector3d(x, y, z)));
  }
  return stages;
}

/// An end state that differs from a known one by less than this share of the similarity thresholds is the same.
constexpr double kSameShare = 0.2;

}  // namespace

Search::Search(const PathQuery& query, MotionSpace space, const Parameters& parameters, RunContext& context)
    : query_(query), parameters_(parameters), context_(context),
      world_(query.simulator.world(query.assembly, query.prepared, query.cast, space)),
      bodies_(balls(*world_)), actions_(action_stages(*world_, parameters)),
      seen_(bodies_, parameters.similarity_translation, parameters.similarity_rotation),
      fine_(bodies_, kSameShare * parameters.similarity_translation, kSameShare * parameters.similarity_rotation) {}

void Search::reset() {
  seen_ = path::StateSet(bodies_, parameters_.similarity_translation, parameters_.similarity_rotation);
  fine_ = path::StateSet(bodies_, kSameShare * parameters_.similarity_translation,
                         kSameShare * parameters_.similarity_rotation);
  nodes_.clear();
  ends_.assign(1, {});
  middles_.assign(1, {});
  ends_[0].push_back(add_node(-1, 0, world_->initial_state(), {}));
}

std::int32_t Search::add_node(std::int32_t parent, unsigned depth, const State& state, Path way) {
  Node node{state, parent, depth, std::move(way), 0};
  for (auto& b : node.state.bodies) b.velocity.setZero(), b.angular_velocity.setZero();
  const auto id = static_cast<std::int32_t>(nodes_.size());
  seen_.add(node.state, static_cast<std::uint32_t>(id));
  fine_.add(node.state, static_cast<std::uint32_t>(id));
  double way_from_start = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    way_from_start = std::max(way_from_start, (state.bodies[i].pose * bodies_[i].center -
                                               query_.cast.moving[i].pose * bodies_[i].center).norm());
  if (way_from_start > farthest_) {
    farthest_ = way_from_start;
    best_.clear();
    for (const auto& b : state.bodies) best_.push_back(b.pose);
  }
  nodes_.push_back(std::move(node));
  return id;
}

Path Search::path_to(std::int32_t node) const {
  std::vector<const Path*> pieces;
  std::int32_t at = node;
  for (; nodes_[static_cast<std::size_t>(at)].parent >= 0; at = nodes_[static_cast<std::size_t>(at)].parent)
    pieces.push_back(&nodes_[static_cast<std::size_t>(at)].way);
  Path path;
  path.emplace_back();
  for (const auto& b : nodes_[static_cast<std::size_t>(at)].state.bodies) path.back().push_back(b.pose);
  for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece)
    path.insert(path.end(), (*piece)->begin(), (*piece)->end());
  return path;
}

void Search::note_contacts(const State& state) {
  std::vector<Contact> contacts;
  world_->contacts(state, contacts);
  std::vector<PartId> parts;
  const auto moves = [&](PartId part) {
    return std::any_of(query_.cast.moving.begin(), query_.cast.moving.end(),
                       [part](const PlacedPart& m) { return m.part == part; });
  };
  for (const auto& c : contacts)
    if (c.depth > -1e-3 && !moves(c.other)) parts.push_back(c.other);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  for (PartId p : parts) ++touched_[p];
}

bool Search::out_of_budget() const {
  return (limited_steps_ && *steps_left_ == 0) || context_.should_stop() || deadline_.passed();
}

/// Applies one action from a node until the state is out, similar to a past one, or moves no more.
Search::RunEnd Search::follow(std::int32_t from, const Action& action, PathResult& result) {
  const auto first_of_run = static_cast<std::uint32_t>(nodes_.size());
  const unsigned depth = nodes_[static_cast<std::size_t>(from)].depth + 1;
  State state = nodes_[static_cast<std::size_t>(from)].state;
  const State start = state;
  std::int32_t last = from;
  bool left_start = false;
  while (true) {
    if (out_of_budget()) return RunEnd::stop;
    Path way;
    const StepReport report = world_->advance(state, action, parameters_.time_step, &way);
    steps_ += report.steps;
    if (limited_steps_) *steps_left_ -= std::min(*steps_left_, report.steps);
    if (!report.finite) return RunEnd::blocked;
    const bool out = !way.empty() && world_->separated(state);
    left_start = left_start || !seen_.similar(state, start);
    // The start of the run is a past state too, but only once the run has left it.
    const bool known = left_start && seen_.has_similar(state, first_of_run, static_cast<std::uint32_t>(nodes_.size()));
    const bool ended = report.stalled || known;
    if (ended) note_contacts(state);
    if (!out && ended) {
      if (fine_.similar(state, nodes_[static_cast<std::size_t>(last)].state)) {
        // Nothing gained since the last recorded state: that one is the end of the run.
        if (last == from) return RunEnd::blocked;
        auto& queue = middles_[depth];
        if (!queue.empty() && queue.back() == last) {
          queue.pop_back();
          ends_[depth].push_back(last);
        } else if (!parameters_.intermediate) {
          ends_[depth].push_back(last);
        }
        return RunEnd::blocked;
      }
      if (fine_.has_similar(state)) return RunEnd::blocked;
      if (ends_.size() <= depth) ends_.resize(depth + 1), middles_.resize(depth + 1);
      ends_[depth].push_back(add_node(last, depth, state, std::move(way)));
      return RunEnd::blocked;
    }
    if (ends_.size() <= depth) ends_.resize(depth + 1), middles_.resize(depth + 1);
    last = add_node(last, depth, state, std::move(way));
    if (out) {
      const Path path = path::thin(path_to(last), bodies_, parameters_.thinning);
      const Verdict verdict = query_.judge(path);
      if (verdict.accepted) {
        note_contacts(start);
        result.outcome = Outcome::solved;
        result.path = path;
        result.depth = depth;
        return RunEnd::solved;
      }
      ++refused_;
      result.message = verdict.reason;
      if (verdict.has_witness) {
        world_->learn(verdict.part, verdict.other, verdict.point);
          return RunEnd::refused_learned;
      }
      return RunEnd::refused;
    }
    if (parameters_.intermediate) middles_[depth].push_back(last);
  }
}

void Search::finish(PathResult& result) const {
  result.counts = {{"nodes", static_cast<double>(nodes_.size())}, {"expanded", static_cast<double>(expanded_)},
                   {"steps", static_cast<double>(steps_)},       {"refused", static_cast<double>(refused_)}};
  std::vector<std::pair<std::uint64_t, PartId>> order;
  for (const auto& [part, times] : touched_) order.emplace_back(times, part);
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  for (const auto& o : order) result.blocked_by.push_back(o.second);
  result.best_pose = best_;
}

bool Search::waiting_at(unsigned depth) const {
  return depth < ends_.size() && (!ends_[depth].empty() || !middles_[depth].empty());
}

/// All actions that this state has not been given yet, up to `stage`.
Search::RunEnd Search::expand(std::int32_t node, std::size_t stage, PathResult& result) {
  ++expanded_;
  for (std::size_t s = nodes_[static_cast<std::size_t>(node)].stages_done; s <= stage; ++s)
    for (const Action& action : actions_[s]) {
      const RunEnd end = follow(node, action, result);
      if (end == RunEnd::solved || end == RunEnd::stop || end == RunEnd::refused_learned) return end;
      if (refused_ > static_cast<std::uint64_t>(parameters_.max_refusals)) return RunEnd::refused;
    }
  nodes_[static_cast<std::size_t>(node)].stages_done = static_cast<unsigned>(stage + 1);
  return RunEnd::blocked;
}

/// Breadth first: by depth, ends of runs before states in their middle, first come first served.
Search::RunEnd Search::sweep(std::size_t stage, std::uint64_t max_nodes, PathResult& result) {
  const unsigned limit = query_.effort.max_depth;
  for (unsigned depth = 0; depth < ends_.size() && (limit == 0 || depth < limit); ++depth)
    while (waiting_at(depth)) {
      if (max_nodes > 0 && expanded_ >= max_nodes) return RunEnd::blocked;
      auto& queue = ends_[depth].empty() ? middles_[depth] : ends_[depth];
      const std::int32_t node = queue.front();
      queue.pop_front();
      const RunEnd end = expand(node, stage, result);
      if (end != RunEnd::blocked) return end;
    }
  return RunEnd::blocked;
}

PathResult Search::run(const Deadline& deadline, std::uint64_t& steps_left, bool limited_steps, std::uint64_t max_nodes) {
  deadline_ = deadline;
  steps_left_ = &steps_left;
  limited_steps_ = limited_steps;
  PathResult result;
  reset();
  if (world_->separated(nodes_.front().state)) {
    result.outcome = Outcome::start_is_goal;
    result.path = path_to(0);
    result.path.push_back(result.path.front());
    finish(result);
    return result;
  }
  RunEnd end = RunEnd::blocked;
  bool waiting = false;
  for (std::size_t stage = 0; stage < actions_.size();) {
    end = sweep(stage, max_nodes, result);
    if (end == RunEnd::refused_learned && refused_ <= static_cast<std::uint64_t>(parameters_.max_refusals)) {
      reset();  // what was found so far may have leaked through the same place
      stage = 0;
      continue;
    }
    waiting = false;
    for (unsigned d = 0; d < ends_.size(); ++d) waiting |= waiting_at(d);
    if (end == RunEnd::blocked && (waiting || stage + 1 == actions_.size()) && world_->relax()) {
      reset();  // once more, with all the overlap that the judge allows
      stage = 0;
      continue;
    }
    if (end != RunEnd::blocked || waiting || ++stage == actions_.size()) break;
    // The axes are exhausted: push every state found so far along the further directions.
    for (std::size_t i = 0; i < nodes_.size(); ++i) ends_[nodes_[i].depth].push_back(static_cast<std::int32_t>(i));
  }
  if (end == RunEnd::solved) {
    result.message.clear();
  } else if (end == RunEnd::stop) {
    result.outcome = context_.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout;
  } else if (refused_ > static_cast<std::uint64_t>(parameters_.max_refusals)) {
    result.outcome = Outcome::exhausted;
  } else {
    result.outcome = waiting ? Outcome::depth_limit : Outcome::exhausted;
  }
  finish(result);
  return result;
}

}  // namespace dismantle::bfs
