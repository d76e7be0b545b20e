#include "dismantle/ompl/sampling_problem.h"

#include <ompl/util/Console.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/search/placed_parts.h"
#include "dismantle/search/shortcuts.h"
#include "dismantle/search/time_limit.h"

namespace dismantle::sampling {
namespace {

using StateType = DisplacementSpace::StateType;

/// OMPL logs to the terminal by default, but a planner must not print.
void silence_ompl() {
  static std::once_flag once;
  std::call_once(once, [] { ompl::msg::setLogLevel(ompl::msg::LOG_NONE); });
}

}  // namespace

CheckBudget::CheckBudget(const PathQuery& query, const RunContext& run)
    : max_checks(query.budget.max_steps), context(run), deadline(path::deadline_of(query, run)) {}

bool CheckBudget::spent() const {
  return (max_checks > 0 && checks >= max_checks) || context.cancel.cancelled() || deadline.passed();
}

Outcome CheckBudget::why() const { return context.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout; }

Surroundings::Surroundings(const PathQuery& query, const World& world, const Pose& goal) {
  const auto& moving = query.scene.moving;
  std::vector<Eigen::Vector3d> points;
  for (const auto& m : moving)
    for (const auto& v : query.assembly.parts[m.part].mesh->vertices) points.push_back(m.pose * v);
  moving_hull = hull_corners(points);
  for (std::size_t i = 0; i < moving.size(); ++i)
    mover.center += moving[i].pose * world.center(i) / static_cast<double>(moving.size());
  for (const auto& p : moving_hull) mover.radius = std::max(mover.radius, (p - mover.center).norm());
  rest = path::box_of(query.assembly, query.scene.fixed);
  bounds = rest;
  bounds.extend(moving_box({}));
  bounds.extend(moving_box(goal));
  bounds.inflate(1.2 * mover.radius + 0.05 * bounds.size().maxCoeff());
}

Aabb Surroundings::moving_box(const Pose& displacement) const {
  Aabb box;
  for (const auto& p : moving_hull) box.extend(displacement * p);
  return box;
}

class SamplingProblem::Checker final : public ompl::base::StateValidityChecker {
 public:
  Checker(SamplingProblem& problem, const ompl::base::SpaceInformationPtr& information)
      : StateValidityChecker(information.get()), problem_(problem) {}
  bool isValid(const ompl::base::State* state) const override {
    return problem_.is_free(*static_cast<const StateType*>(state));
  }

 private:
  SamplingProblem& problem_;
};

/// OMPL's discrete validator takes its step as a fraction of the space's extent; this validator takes a length.
class SamplingProblem::Validator final : public ompl::base::MotionValidator {
 public:
  Validator(SamplingProblem& problem, const ompl::base::SpaceInformationPtr& information)
      : MotionValidator(information.get()), problem_(problem) {}
  bool checkMotion(const ompl::base::State* a, const ompl::base::State* b) const override {
    return problem_.motion_is_free(*static_cast<const StateType*>(a), *static_cast<const StateType*>(b));
  }
  bool checkMotion(const ompl::base::State* a, const ompl::base::State* b,
                   std::pair<ompl::base::State*, double>& last) const override {
    last.second = problem_.free_share(*static_cast<const StateType*>(a), *static_cast<const StateType*>(b));
    if (last.first != nullptr) problem_.space().interpolate(a, b, last.second, last.first);
    return last.second >= 1;
  }

 private:
  SamplingProblem& problem_;
};

SamplingProblem::SamplingProblem(const PathQuery& query, MotionSpace motion, double max_penetration, double step,
                                 CheckBudget& budget, const Pose& goal)
    : query_(query),
      world_(query.simulator.world(query.assembly, query.prepared, query.scene, motion)),
      surroundings_(query, *world_, goal),
      space_(std::make_shared<DisplacementSpace>(surroundings_.mover, motion, surroundings_.bounds)),
      budget_(budget),
      step_(step),
      deviation_(std::max(0.5 * (query.tolerance - max_penetration), geometry::kRounding)),
      start_(path::poses_of(query.scene.moving)) {
  silence_ompl();
  // With inexact CAD data the start may exceed the limit. Its initial penetration must not block the search.
  allowed_ = std::max(max_penetration, world_->penetration(world_->initial_state()));
  information_ = std::make_shared<ompl::base::SpaceInformation>(space_);
  information_->setStateValidityChecker(std::make_shared<Checker>(*this, information_));
  information_->setMotionValidator(std::make_shared<Validator>(*this, information_));
  // The same step as a fraction, for code that asks OMPL for it.
  space_->setLongestValidSegmentFraction(step / space_->getMaximumExtent());
}

std::vector<Pose> SamplingProblem::poses(const StateType& state) const {
  const Pose displacement = space_->displacement(state);
  std::vector<Pose> all;
  for (const auto& p : start_) all.push_back(displacement * p);
  return all;
}

State SamplingProblem::world_state(const StateType& state) const {
  State s;
  for (const auto& p : poses(state)) s.bodies.push_back({p, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  return s;
}

bool SamplingProblem::is_free(const StateType& state) {
  ++budget_.checks;
  if (world_->penetration(world_state(state)) <= allowed_) return true;
  note_blocked(state);
  return false;
}

bool SamplingProblem::is_separated(const StateType& state) { return world_->separated(world_state(state)); }

double SamplingProblem::free_share(const StateType& from, const StateType& to) {
  const double steps = std::ceil(space_->distance(from, to) / step_ - 1e-9);
  for (double k = 1; k <= steps; ++k) {
    if (std::fmod(k, 32) == 0 && budget_.spent())  // reading the clock costs more than a cheap state check
      return (k - 1) / steps;
    if (!is_free(k < steps ? space_->between(from, to, k / steps) : to)) return (k - 1) / steps;
  }
  return 1;
}

StateType SamplingProblem::state_after(const Pose& displacement) const {
  StateType state;
  state.center = displacement * surroundings_.mover.center;
  state.turn = displacement.q;
  return state;
}

std::optional<StateType> SamplingProblem::draw_disassembled(Rng& rng) {
  StateType state;
  for (int attempt = 0; attempt < 10'000; ++attempt) {
    space_->draw(rng, state);
    if (is_separated(state)) return state;
  }
  return std::nullopt;
}

StateType SamplingProblem::exit(const StateType& from, int side) const {
  const Aabb box = surroundings_.moving_box(space_->displacement(from));
  StateType to = from;
  const int axis = side / 2;
  // The boxes are one tolerance apart: more than the rounding of any simulator.
  to.center[axis] += side % 2 == 0 ? surroundings_.rest.lo[axis] - box.hi[axis] - query_.tolerance
                                   : surroundings_.rest.hi[axis] - box.lo[axis] + query_.tolerance;
  return to;
}

Path SamplingProblem::path(const std::vector<StateType>& states, std::vector<std::size_t>* edge_of_instant) const {
  Path path{start_};
  if (edge_of_instant != nullptr) *edge_of_instant = {0};
  for (std::size_t k = 1; k < states.size(); ++k) {
    std::vector<Pose> displacements;
    append_edge(*space_, states[k - 1], states[k], deviation_, displacements);
    for (const auto& d : displacements) {
      path.emplace_back();
      for (const auto& p : start_) path.back().push_back(d * p);
      if (edge_of_instant != nullptr) edge_of_instant->push_back(k);
    }
  }
  return path;
}

std::vector<StateType> SamplingProblem::shortcut(const std::vector<StateType>& states) {
  return path::shortcut_by_halving(states,
                                   [this](const StateType& a, const StateType& b) { return motion_is_free(a, b); });
}

void SamplingProblem::note_blocked(const StateType& state) {
  // Keeps the first 16 and then each whose number is a power of two: a small sample over the whole search.
  const std::uint64_t n = ++blocked_;
  if (n <= 16 || (n & (n - 1)) == 0) blocked_states_.push_back(state);
}

std::vector<PartId> SamplingProblem::blockers() const {
  // Checks each state against each fixed part alone: about 64 checks in addition to the budget.
  std::vector<std::pair<std::size_t, PartId>> hits;
  const std::size_t states = std::min(
      blocked_states_.size(), std::max<std::size_t>(1, 64 / std::max<std::size_t>(1, query_.scene.fixed.size())));
  const auto end = blocked_states_.begin() + static_cast<std::ptrdiff_t>(states);
  for (const auto& fixed : query_.scene.fixed) {
    const auto alone =
        query_.simulator.world(query_.assembly, query_.prepared, {query_.scene.moving, {fixed}}, world_->space());
    const auto count = static_cast<std::size_t>(std::count_if(blocked_states_.begin(), end, [&](const StateType& s) {
      return alone->penetration(world_state(s)) > allowed_;
    }));
    if (count > 0) hits.emplace_back(count, fixed.part);
  }
  std::sort(hits.begin(), hits.end(),
            [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
  std::vector<PartId> parts;
  for (const auto& h : hits) parts.push_back(h.second);
  return parts;
}

}  // namespace dismantle::sampling
