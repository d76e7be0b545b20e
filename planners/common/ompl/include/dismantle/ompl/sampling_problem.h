/// The problem of a sampling planner: validity of states and motions, the goal, and the budget.
#pragma once

#include <ompl/base/Goal.h>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>

#include <memory>
#include <optional>
#include <vector>

#include "dismantle/ompl/displacement_space.h"
#include "dismantle/path_planner.h"

namespace dismantle::sampling {

/// Budget of one search, shared by all its trees.
struct CheckBudget {
  CheckBudget(const PathQuery& query, const RunContext& context);
  bool spent() const;   ///< cancelled, past the deadline, or no checks left
  Outcome why() const;  ///< the outcome when spent: cancelled or timeout

  std::uint64_t checks = 0;      ///< state checks
  std::uint64_t max_checks = 0;  ///< 0 = no limit
  const RunContext& context;
  Deadline deadline;
};

/// Geometry of the query that does not depend on the state space.
struct Surroundings {
  /// `goal`: a displacement that the bounds must also contain.
  Surroundings(const PathQuery& query, const World& world, const Pose& goal = {});
  Mover mover;
  Aabb rest;                                 ///< box of all fixed parts, world
  std::vector<Eigen::Vector3d> moving_hull;  ///< corners of the moving parts' hull, at the start
  Aabb bounds;                               ///< of the mover's centre, with room for exits on every side
  /// Box of the moving parts after a displacement.
  Aabb moving_box(const Pose& displacement) const;
};

/// One state space with its world and OMPL objects.
class SamplingProblem {
 public:
  using StateType = DisplacementSpace::StateType;

  /// A state is free when it penetrates no deeper than `max_penetration` (assembly units) or the start, whichever is
  /// deeper. Motions are checked at every `step` of the space's metric.
  SamplingProblem(const PathQuery& query, MotionSpace motion, double max_penetration, double step, CheckBudget& budget,
                  const Pose& goal = {});
  SamplingProblem(const SamplingProblem&) = delete;
  SamplingProblem& operator=(const SamplingProblem&) = delete;

  const DisplacementSpace& space() const { return *space_; }
  const Surroundings& surroundings() const { return surroundings_; }
  const ompl::base::SpaceInformationPtr& information() const { return information_; }
  CheckBudget& budget() { return budget_; }
  double step() const { return step_; }
  double allowed() const { return allowed_; }

  bool is_free(const StateType& state);
  bool is_separated(const StateType& state);
  /// Share in [0, 1] of the motion that is free, in whole steps; 1: all of it. Stops early when the budget is spent.
  /// `from` must be free.
  double free_share(const StateType& from, const StateType& to);
  bool motion_is_free(const StateType& from, const StateType& to) { return free_share(from, to) >= 1; }

  /// The state after a displacement since the start.
  StateType state_after(const Pose& displacement) const;
  /// A random separated state; nothing if none was found.
  std::optional<StateType> draw_disassembled(Rng& rng);
  /// The state moved out of the fixed parts' box on the given side, 0 to 5 for -x, +x, -y, ...
  StateType exit(const StateType& from, int side) const;

  /// Path through states; the first is the start. Edges with a rotation are subdivided.
  Path path(const std::vector<StateType>& states, std::vector<std::size_t>* edge_of_instant = nullptr) const;
  /// Replaces states between two others by free straight motions (greedy halving). Deterministic.
  std::vector<StateType> shortcut(const std::vector<StateType>& states);

  /// Fixed parts that blocked states, most frequent first, estimated from a sample of the blocked states.
  std::vector<PartId> blockers() const;
  /// Poses of the moving parts in `state`.
  std::vector<Pose> poses(const StateType& state) const;

 private:
  class Checker;
  class Validator;
  State world_state(const StateType& state) const;
  void note_blocked(const StateType& state);

  const PathQuery& query_;
  std::unique_ptr<World> world_;
  Surroundings surroundings_;
  std::shared_ptr<DisplacementSpace> space_;
  ompl::base::SpaceInformationPtr information_;
  CheckBudget& budget_;
  double step_ = 0, allowed_ = 0;
  double deviation_ = 0;  // largest deviation of a path from its edges: half of the tolerance that the states leave
  std::vector<Pose> start_;
  std::uint64_t blocked_ = 0;
  std::vector<StateType> blocked_states_;
};

/// The OMPL goal "disassembled": hulls are disjoint.
class SeparatedGoal final : public ompl::base::Goal {
 public:
  explicit SeparatedGoal(SamplingProblem& problem) : Goal(problem.information()), problem_(problem) {}
  bool isSatisfied(const ompl::base::State* state) const override {
    return problem_.is_separated(*static_cast<const SamplingProblem::StateType*>(state));
  }

 private:
  SamplingProblem& problem_;
};

}  // namespace dismantle::sampling
