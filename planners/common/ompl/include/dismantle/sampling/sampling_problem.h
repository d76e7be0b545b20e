/// What a sampling planner asks of a query: is this state free, is this motion free, is it out, have we time left?
#pragma once

#include <ompl/base/Goal.h>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>

#include <memory>
#include <optional>
#include <vector>

#include "dismantle/path_planner.h"
#include "dismantle/sampling/displacement_space.h"

namespace dismantle::sampling {

/// Budget of one search, shared by all its trees.
struct CheckBudget {
  CheckBudget(const PathQuery& query, const RunContext& context);
  bool spent() const;   ///< nothing may be done any more: cancelled, too late, or
                        ///< too many checks
  Outcome why() const;  ///< when spent: cancelled or timeout

  std::uint64_t checks = 0;      ///< states looked at
  std::uint64_t max_checks = 0;  ///< 0 = no limit
  const RunContext& context;
  Deadline deadline;
};

/// Geometry of the query that does not depend on the state space.
struct Surroundings {
  /// `goal`: a displacement that must be within the bounds, too.
  Surroundings(const PathQuery& query, const World& world, const Pose& goal = {});
  Mover mover;
  Aabb rest;                                 ///< of all that stay fixed, world
  std::vector<Eigen::Vector3d> moving_hull;  ///< corners of all that moves, where they are at the start
  Aabb bounds;                               ///< of the mover's centre: room to get out on every side
  /// Box of what moves after a displacement.
  Aabb moving_box(const Pose& displacement) const;
};

/// One state space over one world, with OMPL's objects for it.
class SamplingProblem {
 public:
  using StateType = DisplacementSpace::StateType;

  /// States penetrating no deeper than `max_penetration` (assembly units), or than the start does, are free; motions
  /// are looked at every `step` of the space's metric.
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
  bool is_out(const StateType& state);
  /// Share in [0, 1] of the motion that is free, in whole steps: 1 = all of it. Stops early when the budget is spent.
  /// The beginning is taken to be free.
  double free_share(const StateType& from, const StateType& to);
  bool motion_is_free(const StateType& from, const StateType& to) { return free_share(from, to) >= 1; }

  /// The state after a displacement since the start.
  StateType state_after(const Pose& displacement) const;
  /// A state that is out, drawn at random. Nothing if none was found (the bounds leave room for many).
  std::optional<StateType> draw_disassembled(Rng& rng);
  /// Displacements along which the part leaves the box of the rest on the side given, 0 to 5 for -x, +x, -y, ...
  StateType exit(const StateType& from, int side) const;

  /// Path through states: the first is the start. Edges are cut where turning asks for it.
  Path path(const std::vector<StateType>& states, std::vector<std::size_t>* edge_of_instant = nullptr) const;
  /// Shortest sequence that greedy halving finds: straight motions that are free replace what lies between. Draws
  /// nothing.
  std::vector<StateType> shortcut(const std::vector<StateType>& states);

  /// Still parts that were hit, most often hit first. Looks at the samples of blocked states that were kept.
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
  std::vector<Pose> start_;
  std::uint64_t blocked_ = 0;
  std::vector<StateType> blocked_states_;
};

/// The OMPL goal "disassembled": hulls apart.
class SeparatedGoal final : public ompl::base::Goal {
 public:
  explicit SeparatedGoal(SamplingProblem& problem) : Goal(problem.information()), problem_(problem) {}
  bool isSatisfied(const ompl::base::State* state) const override {
    return problem_.is_out(*static_cast<const SamplingProblem::StateType*>(state));
  }

 private:
  SamplingProblem& problem_;
};

}  // namespace dismantle::sampling
