#include "level_search.h"

#include <algorithm>
#include <utility>

#include "dismantle/path/touched.h"
#include "dismantle/search/candidates.h"
#include "dismantle/search/placed_parts.h"

namespace dismantle::bfs {
namespace {

State at(const std::vector<Pose>& poses) {
  State state;
  for (const Pose& pose : poses) state.bodies.push_back({pose});
  return state;
}

/// In the order of the published code: forces along +z, -z, +y, -y, +x, -x, then torques about the same axes.
std::vector<Action> actions_of(const World& world, const Parameters& parameters) {
  std::vector<Action> actions;
  const auto add = [&](const Eigen::Vector3d& force, const Eigen::Vector3d& torque) {
    Action action;
    for (std::size_t i = 0; i < world.scene().moving.size(); ++i)
      action.wrenches.push_back({force, parameters.torque > 0
                                            ? Eigen::Vector3d(parameters.torque * torque)
                                            : Eigen::Vector3d(parameters.force * world.torque_arm(i) * torque)});
    actions.push_back(std::move(action));
  };
  for (const int axis : {2, 1, 0})
    for (const double sign : {1.0, -1.0})
      add(sign * parameters.force * Eigen::Vector3d::Unit(axis), Eigen::Vector3d::Zero());
  if (world.space() == MotionSpace::translation) return actions;
  for (const int axis : {2, 1, 0})
    for (const double sign : {1.0, -1.0}) add(Eigen::Vector3d::Zero(), sign * Eigen::Vector3d::Unit(axis));
  return actions;
}

}  // namespace

LevelSearch::LevelSearch(const PathQuery& query, MotionSpace space, const Parameters& parameters, RunContext& context,
                         const Levels* earlier)
    : query_(query),
      parameters_(parameters),
      context_(context),
      world_(query.simulator.world(query.assembly, query.prepared, query.scene, space)),
      bodies_(path::balls_of(*world_)),
      actions_(actions_of(*world_, parameters)),
      ends_({}, 1, 1),
      record_(query, context) {
  // The verifier and the published code allow the initial overlap of a pair everywhere.
  world_->allow_overlap_everywhere();
  begin();
  if (earlier == nullptr) return;
  for (const path::ContactSample& s : earlier->samples) world_->add_contact_sample(s.part, s.other, s.point);
  levels_ = *earlier;
  record_.restart();
  for (const Node& node : levels_.nodes) record_.node(node.parent, path::poses_of(node.state), 0, remember(node.state));
  resumed_ = levels_.nodes.size();
  spared_ = levels_.work;
}

void LevelSearch::begin() {
  ends_ = path::StateSet(bodies_, parameters_.distinct_translation, parameters_.distinct_rotation);
  levels_.nodes.clear();
  levels_.next.clear();
  levels_.at = levels_.action = 0;
  record_.restart();
  levels_.level = {add({.state = world_->initial_state()})};
}

/// Returns how far the centre of a part has moved, at most.
double LevelSearch::remember(const State& state) {
  ends_.add(state, 0);
  double distance = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Eigen::Vector3d& center = bodies_[i].center;
    distance = std::max(distance, (state.bodies[i].pose * center - query_.scene.moving[i].pose * center).norm());
  }
  if (distance <= farthest_) return distance;
  farthest_ = distance;
  best_ = path::poses_of(state);
  return distance;
}

std::int32_t LevelSearch::add(Node node) {
  for (auto& b : node.state.bodies) b.velocity.setZero(), b.angular_velocity.setZero();
  const double distance = remember(node.state);
  if (record_.listens()) record_.node(node.parent, path::poses_of(node.state), static_cast<double>(steps_), distance);
  levels_.nodes.push_back(std::move(node));
  return static_cast<std::int32_t>(levels_.nodes.size() - 1);
}

/// The longest path comes first: a path that unscrews a part has the most instants.
void LevelSearch::next_level() {
  levels_.level = std::exchange(levels_.next, {});
  levels_.at = 0;
  if (parameters_.order == Order::longest_first)
    std::stable_sort(levels_.level.begin(), levels_.level.end(), [this](std::int32_t a, std::int32_t b) {
      return levels_.nodes[static_cast<std::size_t>(a)].instants > levels_.nodes[static_cast<std::size_t>(b)].instants;
    });
}

bool LevelSearch::over() const {
  return (steps_left_ != nullptr && *steps_left_ == 0) || context_.should_stop() || deadline_.passed();
}

Path LevelSearch::path_to(std::int32_t node) const {
  std::vector<const Node*> line;
  for (std::int32_t n = node; n >= 0; n = line.back()->parent)
    line.push_back(&levels_.nodes[static_cast<std::size_t>(n)]);
  Path path{path::poses_of(line.back()->state)};
  for (auto n = line.rbegin() + 1; n != line.rend(); ++n)
    path.insert(path.end(), (*n)->distance.begin(), (*n)->distance.end());
  return path;
}

/// Checks the path to a separated state. If it is refused at a known place, that place becomes a contact sample.
LevelSearch::End LevelSearch::verify(std::int32_t last, PathResult& result) {
  const Path path = path::thin(path_to(last), bodies_, parameters_.thinning * query_.tolerance);
  const PathCheck check = query_.checker.check(path);
  if (check.accepted()) {
    result.solve(*check.verified, levels_.nodes[static_cast<std::size_t>(last)].depth);
    return End::solved;
  }
  ++refused_;
  result.message = check.reason;
  if (check.has_witness) {
    world_->add_contact_sample(check.part, check.other, check.point);
    levels_.samples.push_back({check.part, check.other, check.point});
  }
  return End::refused;
}

LevelSearch::End LevelSearch::follow(std::int32_t from, const Action& action, const path::StateSet& passed,
                                     PathResult& result) {
  const Node& start = levels_.nodes[static_cast<std::size_t>(from)];
  Node end{.state = start.state, .parent = from, .depth = start.depth + 1};
  path::StateSet run(bodies_, parameters_.similarity_translation, parameters_.similarity_rotation);
  while (true) {
    if (over()) return End::stopped;
    const std::size_t before = end.distance.size();
    for (auto& b : end.state.bodies) b.velocity.setZero(), b.angular_velocity.setZero();
    const StepReport report = world_->advance(end.state, action, parameters_.time_step, &end.distance);
    steps_ += report.steps;
    levels_.work += report.steps;
    if (steps_left_ != nullptr) *steps_left_ -= std::min(*steps_left_, report.steps);
    if (!report.finite) return End::searched;
    end.instants = start.instants + end.distance.size();
    if (end.distance.size() > before && world_->separated(end.state)) return verify(add(std::move(end)), result);
    if (passed.has_similar(end.state) || run.has_similar(end.state)) break;
    for (std::size_t k = before; k < end.distance.size(); ++k) run.add(at(end.distance[k]), 0);
  }
  std::vector<Contact> contacts;
  world_->contacts(end.state, contacts);
  for (const PartId p : path::touched_parts(contacts, query_.scene.moving, query_.tolerance)) ++touched_[p];
  if (!ends_.has_similar(end.state)) levels_.next.push_back(add(std::move(end)));
  return End::searched;
}

/// Applies the actions that a state has not had yet.
LevelSearch::End LevelSearch::expand(std::int32_t from, PathResult& result) {
  path::StateSet passed(bodies_, parameters_.similarity_translation, parameters_.similarity_rotation);
  for (const auto& instant : path_to(from)) passed.add(at(instant), 0);
  for (; levels_.action < actions_.size(); ++levels_.action) {
    const std::size_t known = levels_.samples.size();
    const End end = follow(from, actions_[levels_.action], passed, result);
    if (end == End::solved || end == End::stopped) return end;
    if (end != End::refused) continue;
    if (refused_ > static_cast<std::uint64_t>(parameters_.max_refusals)) return end;
    if (levels_.samples.size() == known) continue;
    begin();  // earlier paths may have penetrated at the same place, so the search restarts
    return End::searched;
  }
  ++expanded_;
  ++levels_.at;
  levels_.action = 0;
  return End::searched;
}

LevelSearch::End LevelSearch::run(unsigned depth, const Deadline& deadline, std::uint64_t* steps_left,
                                  std::uint64_t pause_after, PathResult& result) {
  deadline_ = deadline;
  steps_left_ = steps_left;
  const std::uint64_t begin_steps = steps_;
  while (true) {
    if (levels_.at == levels_.level.size()) {
      if (levels_.next.empty()) return End::searched;
      next_level();
    }
    const std::int32_t from = levels_.level[levels_.at];
    if (levels_.nodes[static_cast<std::size_t>(from)].depth >= depth) return End::searched;
    if (pause_after > 0 && steps_ - begin_steps >= pause_after) return End::paused;
    if (const End end = expand(from, result); end != End::searched) return end;
  }
}

void LevelSearch::report(PathResult& result) const {
  result.stats = {.steps = steps_,
                  .nodes = levels_.nodes.size(),
                  .refused = refused_,
                  .resumed_nodes = resumed_,
                  .spared = spared_,
                  .cost = static_cast<double>(steps_),
                  .extra = {{"expanded", static_cast<double>(expanded_)}}};
  result.blocked_by = path::most_touched(touched_, query_.scene.moving);
  result.best_pose = best_;
}

}  // namespace dismantle::bfs
