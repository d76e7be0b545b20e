#include "dismantle/ompl/displacement_space.h"

#include <ompl/base/StateSampler.h>

#include <cmath>
#include <numbers>

namespace dismantle::sampling {
namespace {

using Turn = Eigen::Quaterniond;
using StateType = DisplacementSpace::StateType;

StateType& state_of(ompl::base::State* s) { return *static_cast<StateType*>(s); }
const StateType& state_of(const ompl::base::State* s) { return *static_cast<const StateType*>(s); }

/// Uniform in SO(3) (Shoemake 1992).
Turn random_turn(Rng& rng) {
  const double u = rng.uniform(), a = rng.uniform(0, 2 * std::numbers::pi), b = rng.uniform(0, 2 * std::numbers::pi);
  const double s = std::sqrt(1 - u), c = std::sqrt(u);
  return Turn(c * std::cos(b), s * std::sin(a), s * std::cos(a), c * std::sin(b)).normalized();
}

class Sampler final : public ompl::base::StateSampler {
 public:
  Sampler(const DisplacementSpace* space, std::uint64_t seed) : StateSampler(space), space_(space), random_(seed) {}

  void sampleUniform(ompl::base::State* state) override { space_->draw(random_, state_of(state)); }
  void sampleUniformNear(ompl::base::State* state, const ompl::base::State* near, double distance) override {
    shift(state_of(state), state_of(near), [&] { return random_.uniform(-distance, distance); });
  }
  void sampleGaussian(ompl::base::State* state, const ompl::base::State* mean, double deviation) override {
    shift(state_of(state), state_of(mean), [&] { return deviation * random_.normal(); });
  }

 private:
  template <class Draw>
  void shift(StateType& state, const StateType& from, const Draw& draw) {
    const auto vector = [&] { return Eigen::Vector3d(draw(), draw(), draw()); };
    state.center = from.center + vector();
    state.turn = from.turn;
    if (space_->motion() == MotionSpace::rigid)
      state.turn = rotation_from_vector(vector() / std::max(space_->mover().radius, 1e-9)) * from.turn;
    space_->enforceBounds(&state);
  }
  const DisplacementSpace* space_;
  Rng random_;
};

}  // namespace

DisplacementSpace::DisplacementSpace(const Mover& mover, MotionSpace motion, const Aabb& bounds)
    : mover_(mover), motion_(motion), bounds_(bounds) {
  type_ = ompl::base::STATE_SPACE_UNKNOWN;
  setName(motion == MotionSpace::translation ? "displacement in R3" : "displacement in SE(3)");
}

StateType DisplacementSpace::start() const {
  StateType s;
  s.center = mover_.center;
  return s;
}

void DisplacementSpace::draw(Rng& rng, StateType& state) const {
  for (int k = 0; k < 3; ++k) state.center[k] = rng.uniform(bounds_.lo[k], bounds_.hi[k]);
  state.turn = motion_ == MotionSpace::translation ? Turn::Identity() : random_turn(rng);
}

double DisplacementSpace::distance(const StateType& a, const StateType& b) const {
  const double distance = (a.center - b.center).norm();
  return motion_ == MotionSpace::translation ? distance : distance + mover_.radius * angle_between(a.turn, b.turn);
}

StateType DisplacementSpace::between(const StateType& a, const StateType& b, double u) const {
  StateType s;
  s.center = a.center + u * (b.center - a.center);
  if (motion_ == MotionSpace::rigid) s.turn = a.turn.slerp(u, b.turn).normalized();
  return s;
}

double DisplacementSpace::getMaximumExtent() const {
  const double extent = bounds_.size().norm();
  return motion_ == MotionSpace::translation ? extent : extent + mover_.radius * std::numbers::pi;
}

double DisplacementSpace::getMeasure() const {
  const double volume = bounds_.size().prod();
  return motion_ == MotionSpace::translation
             ? volume
             : volume * 8 * std::numbers::pi * std::numbers::pi * std::pow(mover_.radius, 3);
}

void DisplacementSpace::enforceBounds(ompl::base::State* state) const {
  state_of(state).center = state_of(state).center.cwiseMax(bounds_.lo).cwiseMin(bounds_.hi);
  state_of(state).turn.normalize();
}

bool DisplacementSpace::satisfiesBounds(const ompl::base::State* state) const {
  return bounds_.contains(state_of(state).center);
}

void DisplacementSpace::copyState(ompl::base::State* to, const ompl::base::State* from) const {
  state_of(to).center = state_of(from).center;
  state_of(to).turn = state_of(from).turn;
}

double DisplacementSpace::distance(const ompl::base::State* a, const ompl::base::State* b) const {
  return distance(state_of(a), state_of(b));
}

bool DisplacementSpace::equalStates(const ompl::base::State* a, const ompl::base::State* b) const {
  return distance(state_of(a), state_of(b)) < 1e-12;
}

void DisplacementSpace::interpolate(const ompl::base::State* from, const ompl::base::State* to, double u,
                                    ompl::base::State* state) const {
  const StateType s = between(state_of(from), state_of(to), u);
  state_of(state).center = s.center;
  state_of(state).turn = s.turn;
}

ompl::base::StateSamplerPtr DisplacementSpace::allocDefaultStateSampler() const {
  return std::make_shared<Sampler>(this, sampler_seeds_.next());
}

void append_edge(const DisplacementSpace& space, const StateType& first, const StateType& last, double deviation,
                 std::vector<Pose>& displacements) {
  const double length = (last.center - first.center).norm(), turn = angle_between(first.turn, last.turn);
  // On a screw motion the centre moves on an arc with sagitta = length * turn / 8. With n pieces it is n * n times
  // smaller.
  const double pieces = std::max(1.0, std::ceil(std::sqrt(length * turn / 8 / deviation)));
  for (double k = 1; k <= pieces; ++k)
    displacements.push_back(space.displacement(k < pieces ? space.between(first, last, k / pieces) : last));
}

}  // namespace dismantle::sampling
