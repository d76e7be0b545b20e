/// The scene of one attempt under penalty contact (section 4.1).
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "dismantle/simulator.h"
#include "parameters.h"
#include "row_merger.h"
#include "step_solver.h"

namespace dismantle::sdf_penalty {

/// What a pair may overlap beyond its depth when assembled; assembly units, a third of what the verifier lets pass
/// by default.
constexpr double kFacetAllowance = 0.003;

/// What prepare() keeps: shapes and the depth to which each pair overlaps when assembled.
class PreparedShapes final : public Prepared {
 public:
  std::vector<sdf::Placed> placed;
  std::map<std::pair<PartId, PartId>, double> overlap;  ///< a < b; only pairs that overlap
  mutable sdf::RestContacts rest;                       ///< filled by the worlds as they need it
  double allowed(PartId a, PartId b) const {
    const auto found = overlap.find(std::minmax(a, b));
    return found == overlap.end() ? 0.0 : found->second;
  }
};

class PenaltyWorld final : public World {
 public:
  PenaltyWorld(const PreparedShapes& prepared, const Cast& cast, MotionSpace space, const Parameters& parameters);

  const Cast& cast() const override { return cast_; }
  MotionSpace space() const override { return space_; }
  State initial_state() const override;
  Eigen::Vector3d center(std::size_t body) const override { return bodies_[body].center; }
  double radius(std::size_t body) const override { return bodies_[body].radius; }
  double torque_arm(std::size_t body) const override { return bodies_[body].radius; }
  StepReport advance(State& state, const Action& action, double duration, Trace* trace) override;
  double penetration(const State& state) override;
  void retreat(State& state, double clearance) override;
  void contacts(const State& state, std::vector<Contact>& out) override;
  bool separated(const State& state) override;
  void learn(PartId part, PartId other, const Eigen::Vector3d& point) override;
  bool strict() const override { return scene_.strict(); }
  void relax() override;

 private:
  struct Body {
    Eigen::Vector3d center;  ///< mass centre, assembled frame
    double radius = 0;
    double mass = 1;                    ///< second order
    Eigen::Matrix3d inertia;            ///< about the centre, assembled frame
    std::vector<Eigen::Vector3d> hull;  ///< assembled frame
  };
  enum class Moved { freely, stalled, not_at_all };

  template <int Dof>
  Moved step(State& state, const Action& action, double dt, double* travel);
  template <int Dof>
  void settle(State& state, double explained);
  template <int Dof>
  typename StepSolver<Dof>::Matrix stay_put(double stiffness) const;
  template <int Dof>
  void keep_off(State& state, double clearance);
  void update_contacts(const State& state);
  template <int Dof>
  void follow_contacts(const State& state, const typename StepSolver<Dof>::Vector& x, double travel);
  void forget_contacts();
  void build_rows(const State& state, double dt);
  template <int Dof>
  double displace(State& state, const typename StepSolver<Dof>::Vector& x) const;
  double quasi_static_step(const Action& action) const;
  double way_from_rest(const Action& action, double duration) const;

  Cast cast_;
  MotionSpace space_;
  Parameters parameters_;
  sdf::ContactScene scene_;
  std::unique_ptr<sdf::ContactScene> sensor_;  ///< sees penetration only; made when first asked for
  std::vector<sdf::ContactPoint> sensed_;      // scratch
  std::vector<Body> bodies_;
  int per_body_ = 3;
  std::vector<Eigen::Vector3d> rest_hull_;  ///< corners of all still parts, world
  Aabb rest_box_;
  std::vector<Pose> poses_;                        // scratch
  std::vector<sdf::ContactPoint> touching_;        // at the state of the last update or follow
  std::vector<Pose> touching_at_;                  // poses that touching_ belongs to; empty: to none
  double since_update_ = 0;                        // way since distances were asked for
  std::vector<sdf::ContactPoint> begin_touching_;  // where the last advance() began: the next often begins there too
  std::vector<Pose> begin_at_;
  std::vector<ContactRow> begin_rows_;
  bool rows_current_ = false;     // rows_ were built from touching_ as it is
  std::vector<ContactRow> rows_;  // scratch
  RowMerger merger_;              // scratch
};

}  // namespace dismantle::sdf_penalty
