/// OMPL state space of the displacement of a part or rigid group, with a metric in assembly units.
#pragma once

#include <ompl/base/StateSpace.h>

#include <Eigen/Geometry>

#include "dismantle/aabb.h"
#include "dismantle/pose.h"
#include "dismantle/run_context.h"
#include "dismantle/simulator.h"

namespace dismantle::sampling {

/// The moving group: its centre in the world at the start, and the largest distance of its points from there (assembly
/// units).
struct Mover {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// R3 or SE(3). A state is the position of the mover's centre and its rotation since the start.
///
/// Metric (assembly units): displacement of the centre plus radius times angle. Between two states the centre moves on
/// a line while the mover rotates at constant speed (OMPL's interpolation for SE(3)), and no point of the mover travels
/// further than the metric. A step in this metric therefore bounds the step of every point.
///
/// Draws nothing from OMPL's process-wide sequence of seeds unless OMPL itself requests a sampler.
class DisplacementSpace final : public ompl::base::StateSpace {
 public:
  struct StateType final : ompl::base::State {
    StateType() = default;
    StateType(const StateType& other) : State(), center(other.center), turn(other.turn) {}  // OMPL's base has no copy
    StateType& operator=(const StateType& other) {
      center = other.center;
      turn = other.turn;
      return *this;
    }
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  };

  /// `bounds`: of the mover's centre, in the world.
  DisplacementSpace(const Mover& mover, MotionSpace motion, const Aabb& bounds);

  const Mover& mover() const { return mover_; }
  MotionSpace motion() const { return motion_; }
  const Aabb& bounds() const { return bounds_; }

  /// Displacement since the start: x' = R x + t for a point at x at the start.
  Pose displacement(const StateType& state) const { return {state.center - state.turn * mover_.center, state.turn}; }
  StateType start() const;
  /// Uniform in the bounds; orientation uniform in SO(3) (Shoemake) when it is free.
  void draw(Rng& rng, StateType& state) const;
  double distance(const StateType& a, const StateType& b) const;
  StateType between(const StateType& a, const StateType& b, double u) const;

  unsigned int getDimension() const override { return motion_ == MotionSpace::translation ? 3 : 6; }
  double getMaximumExtent() const override;
  double getMeasure() const override;
  void enforceBounds(ompl::base::State* state) const override;
  bool satisfiesBounds(const ompl::base::State* state) const override;
  void copyState(ompl::base::State* to, const ompl::base::State* from) const override;
  double distance(const ompl::base::State* a, const ompl::base::State* b) const override;
  bool equalStates(const ompl::base::State* a, const ompl::base::State* b) const override;
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double u,
                   ompl::base::State* state) const override;
  /// For OMPL's own planners. Each sampler gets another seed from the generator given to seed_samplers().
  ompl::base::StateSamplerPtr allocDefaultStateSampler() const override;
  void seed_samplers(const Rng& rng) { sampler_seeds_ = rng; }
  ompl::base::State* allocState() const override { return new StateType; }
  void freeState(ompl::base::State* state) const override { delete static_cast<StateType*>(state); }

 private:
  Mover mover_;
  MotionSpace motion_;
  Aabb bounds_;
  mutable Rng sampler_seeds_{1};
};

/// Subdivides an edge so that the screw motions between the poses of the path stay within `deviation` (assembly units)
/// of the edge. Appends poses after `first`, up to and including `last`.
void append_edge(const DisplacementSpace& space, const DisplacementSpace::StateType& first,
                 const DisplacementSpace::StateType& last, double deviation, std::vector<Pose>& displacements);

}  // namespace dismantle::sampling
