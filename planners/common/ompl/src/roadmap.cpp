#include "dismantle/ompl/roadmap.h"

#include <ompl/geometric/PathGeometric.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>

namespace dismantle::sampling {

namespace ob = ompl::base;

Roadmap::Roadmap(SamplingProblem& problem, const Settings& settings, const Rng& rng)
    : Planner(problem.information(), "Roadmap"), problem_(problem), settings_(settings), rng_(rng) {}

void Roadmap::clear() {
  Planner::clear();
  milestones_.clear();
  near_ = {};
  sampled_ = 0;
  iterations_ = 0;
  components_.clear();
  solution_.clear();
  route_.clear();
}

std::uint32_t Roadmap::component(std::uint32_t node) {
  while (milestones_[node].component != node)
    node = milestones_[node].component = milestones_[milestones_[node].component].component;
  return node;
}

void Roadmap::join(std::uint32_t a, std::uint32_t b) {
  const double length = problem_.space().distance(milestones_[a].state, milestones_[b].state);
  milestones_[a].edges.emplace_back(b, length);
  milestones_[b].edges.emplace_back(a, length);
  merge(a, b);
}

void Roadmap::merge(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t root = std::min(component(a), component(b)), other = std::max(component(a), component(b));
  if (root == other) return;
  milestones_[other].component = root;
  Component &to = components_[root], &from = components_[other];
  if (to.members.size() < from.members.size()) std::swap(to.members, from.members);
  to.members.insert(to.members.end(), from.members.begin(), from.members.end());
  to.goals += from.goals;
  from = {};
}

std::uint32_t Roadmap::add(const StateType& state) {
  const std::uint32_t node = near_.add(state.center);
  milestones_.push_back({state, getProblemDefinition()->getGoal()->isSatisfied(&state), node});
  components_.push_back({{node}, milestones_.back().goal ? 1U : 0U});
  return node;
}

void Roadmap::connect(std::uint32_t node) {
  const auto metric = [&](std::uint32_t n) {
    return problem_.space().distance(milestones_[n].state, milestones_[node].state);
  };
  for (const auto other : near_.nearest(milestones_[node].state.center, metric, settings_.neighbours + 1)) {
    if (other == node || component(other) == component(node)) continue;
    if (problem_.budget().spent()) return;
    ++milestones_[node].tried;
    ++milestones_[other].tried;
    if (problem_.motion_is_free(milestones_[other].state, milestones_[node].state)) {
      join(other, node);
    } else {
      ++milestones_[node].blocked;
      ++milestones_[other].blocked;
    }
  }
}

std::optional<std::uint32_t> Roadmap::expand() {
  const bool at_start = rng_.uniform() < 0.5;
  for (int k = 0; k < 20; ++k) {  // rejection sampling of the milestone to expand
    const auto& reached = components_[0].members;
    const auto node =
        at_start ? reached[rng_.below(reached.size())] : static_cast<std::uint32_t>(rng_.below(milestones_.size()));
    const Milestone& from = milestones_[node];
    if (rng_.uniform() * (from.tried + 2) * (from.expanded + 1) >= from.blocked + 1) continue;
    StateType to;
    problem_.space().draw(rng_, to);
    const double distance = problem_.space().distance(from.state, to);
    if (distance > settings_.range) to = problem_.space().between(from.state, to, settings_.range / distance);
    const double share = problem_.free_share(from.state, to);
    const std::uint32_t hits = share < 1 ? 1 : 0;
    ++milestones_[node].expanded;
    ++milestones_[node].tried;
    milestones_[node].blocked += hits;
    if (share <= 0) return std::nullopt;
    const std::uint32_t end = add(share < 1 ? problem_.space().between(from.state, to, share) : to);
    milestones_[end].tried = 1;
    milestones_[end].blocked = hits;
    join(node, end);
    return end;
  }
  return std::nullopt;
}

/// Draws two states at a random distance; returns the free one if the other is not free.
std::optional<SamplingProblem::StateType> Roadmap::near_obstacle() {
  StateType a, far;
  problem_.space().draw(rng_, a);
  problem_.space().draw(rng_, far);
  const double distance = problem_.space().distance(a, far);
  if (!(distance > 0)) return std::nullopt;
  const StateType b =
      problem_.space().between(a, far, std::min(1.0, std::abs(settings_.range * rng_.normal()) / distance));
  const bool a_free = problem_.is_free(a), b_free = problem_.is_free(b);
  if (a_free == b_free) return std::nullopt;
  return a_free ? a : b;
}

std::optional<std::uint32_t> Roadmap::sample(const ob::GoalSampleableRegion& goal) {
  StateType state;
  if (sampled_ < goal.maxSampleCount()) {
    ++sampled_;
    goal.sampleGoal(&state);
  } else if (rng_.uniform() < settings_.expansion) {
    return expand();
  } else if (rng_.uniform() < settings_.gaussian) {
    const auto near = near_obstacle();
    return near ? std::optional(add(*near)) : std::nullopt;
  } else {
    problem_.space().draw(rng_, state);
  }
  return problem_.is_free(state) ? std::optional(add(state)) : std::nullopt;
}

/// Dijkstra's algorithm from the start to the goal milestone with the shortest path.
bool Roadmap::find_path() {
  solution_.clear();
  route_.clear();
  if (components_[0].goals == 0) return false;
  std::vector<double> length(milestones_.size(), std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> before(milestones_.size(), 0);
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.emplace(length[0] = 0, 0);
  while (!open.empty()) {
    const auto [cost, node] = open.top();
    open.pop();
    if (cost > length[node]) continue;
    if (milestones_[node].goal) {
      for (std::uint32_t n = node; n != 0; n = before[n]) route_.push_back(n);
      route_.push_back(0);
      std::reverse(route_.begin(), route_.end());
      for (const auto n : route_) solution_.push_back(milestones_[n].state);
      return true;
    }
    for (const auto& [to, edge] : milestones_[node].edges)
      if (cost + edge < length[to]) {
        before[to] = node;
        open.emplace(length[to] = cost + edge, to);
      }
  }
  return false;
}

void Roadmap::discard(std::size_t edge) {
  const std::uint32_t a = route_.at(edge - 1), b = route_.at(edge);
  std::erase_if(milestones_[a].edges, [&](const auto& e) { return e.first == b; });
  std::erase_if(milestones_[b].edges, [&](const auto& e) { return e.first == a; });
  ++milestones_[a].blocked, ++milestones_[b].blocked;
  for (std::uint32_t n = 0; n < milestones_.size(); ++n) {
    milestones_[n].component = n;
    components_[n] = {{n}, milestones_[n].goal ? 1U : 0U};
  }
  for (std::uint32_t n = 0; n < milestones_.size(); ++n)
    for (const auto& [to, length] : milestones_[n].edges) merge(n, to);
  solution_.clear();
}

std::optional<SamplingProblem::StateType> Roadmap::farthest() const {
  if (milestones_.empty()) return std::nullopt;
  const auto& reached = components_[0].members;
  const auto distance = [&](std::uint32_t n) {
    return (milestones_[n].state.center - milestones_[0].state.center).squaredNorm();
  };
  const auto best = std::max_element(reached.begin(), reached.end(),
                                     [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
  return milestones_[*best].state;
}

ob::PlannerStatus Roadmap::solve(const ob::PlannerTerminationCondition& stop) {
  checkValidity();
  const auto* goal = dynamic_cast<const ob::GoalSampleableRegion*>(getProblemDefinition()->getGoal().get());
  if (goal == nullptr) return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
  if (milestones_.empty()) {
    const auto start = *static_cast<const StateType*>(getProblemDefinition()->getStartState(0));
    if (!problem_.is_free(start)) return ob::PlannerStatus::INVALID_START;
    add(start);
  }
  while (!stop()) {
    if (components_[0].goals == 0) {
      ++iterations_;
      if (const auto node = sample(*goal)) connect(*node);
    }
    if (!find_path()) continue;
    auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
    for (const auto& s : solution_) path->append(&s);
    getProblemDefinition()->clearSolutionPaths();
    getProblemDefinition()->addSolutionPath(path, false, 0, getName());
    return ob::PlannerStatus::EXACT_SOLUTION;
  }
  return ob::PlannerStatus::TIMEOUT;
}

}  // namespace dismantle::sampling
