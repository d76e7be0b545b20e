/// What worlds of rigid bodies in contact have in common, whatever moves them.
#pragma once

#include <memory>
#include <vector>

#include "dismantle/sdf/contact_row.h"
#include "dismantle/sdf/contact_scene.h"
#include "dismantle/sdf/prepared_shapes.h"
#include "dismantle/sdf/row_merger.h"
#include "dismantle/sdf/step_solver.h"
#include "dismantle/simulator.h"

namespace dismantle::sdf {

/// A body of the scene; assembled frame, assembly units.
struct MovingBody {
  Eigen::Vector3d center;  ///< mass centre
  double radius = 0;       ///< largest distance of a vertex from it, > 0
  std::vector<Eigen::Vector3d> hull;
};

/// How contact is sensed and resisted.
struct ContactOptions {
  DistanceModel distance = DistanceModel::exact;
  bool surroundings = false;  ///< see ContactScene::see_surroundings
  double margin = 0.025;      ///< contacts with a smaller gap are listed
  double threshold = 0;       ///< depth granted to all pairs
  double stiffness = 1e6;     ///< of a contact, N / unit
  double damping = 0;         ///< N s / unit^2
  double max_travel = 0.02;   ///< most that a correction in place may move a point
};

/// Keeps the contacts of the last state asked for, answers what does not depend on the dynamics, and corrects states
/// in place. A displacement x holds per body a shift and (rigid) a rotation vector about the centre, world axes.
class BodyWorld : public World {
 public:
  const Scene& scene() const override { return scene_; }
  MotionSpace space() const override { return space_; }
  State initial_state() const override;
  Eigen::Vector3d center(std::size_t body) const override { return bodies_[body].center; }
  double radius(std::size_t body) const override { return bodies_[body].radius; }
  double torque_arm(std::size_t body) const override { return bodies_[body].radius; }
  double penetration(const State& state) override;
  void project_to_clearance(State& state, double clearance) override;
  void contacts(const State& state, std::vector<Contact>& out) override;
  bool separated(const State& state) override;
  bool body_separated(const State& state, std::size_t body) override;
  void add_contact_sample(PartId part, PartId other, const Eigen::Vector3d& point) override;
  bool overlap_is_local() const override { return contact_scene_.overlap_is_local(); }
  void allow_overlap_everywhere() override;

 protected:
  /// @throws std::invalid_argument unless 1 to kMaxBodies parts move.
  BodyWorld(const PreparedShapes& prepared, const Scene& scene, MotionSpace space, const ContactOptions& options);

  const std::vector<MovingBody>& bodies() const { return bodies_; }
  int per_body() const { return per_body_; }  ///< degrees of freedom: 3 or 6
  /// Depth by which contact may be off, assembly units.
  double contact_depth() const { return contact_depth_; }
  Eigen::Index dof() const { return static_cast<Eigen::Index>(bodies_.size()) * per_body_; }
  const std::vector<ContactPoint>& touching() const { return touching_; }
  const std::vector<ContactRow>& rows() const { return rows_; }
  RowColumns& columns() { return columns_; }
  double deepest() const;  ///< of touching(), >= 0

  /// Contacts and rows at `state`, remembered: the next advance() often begins there too. False, and nothing done, when
  /// a number in state or action is not finite.
  /// @throws std::invalid_argument unless state and action have one entry per body.
  [[nodiscard]] bool begin(const State& state, const Action& action);
  /// Contacts at `state`.
  void update_contacts(const State& state);
  /// Contacts after the bodies were displaced by `x`, no point by more than `travel`: by their own linear model over
  /// short ways, else asked for.
  template <int Dof>
  void follow_contacts(const State& state, const typename StepSolver<Dof>::Vector& x, double travel);
  /// Rows of touching(), with damping over `dt` > 0.
  void build_rows(const State& state, double dt);
  /// Moves the bodies; returns an upper bound of the way of any point.
  template <int Dof>
  double displace(State& state, const typename StepSolver<Dof>::Vector& x) const;
  /// Upper bound of the way of any point under `x`.
  template <int Dof>
  double travel_of(const typename StepSolver<Dof>::Vector& x) const;
  /// Displacement of a point (world) that `body` carries; none for body -1.
  template <int Dof>
  Eigen::Vector3d shift_of(int body, const Eigen::Vector3d& point, const State& state,
                           const typename StepSolver<Dof>::Vector& x) const;
  /// Pushes the state out of surfaces that it is deeper in than `depth`. Contacts are those of `state`, before and
  /// after.
  template <int Dof>
  void settle(State& state, double depth);
  /// What holds all bodies back alike, whichever way they go.
  template <int Dof>
  typename StepSolver<Dof>::Matrix stay_put(double stiffness) const;

 private:
  template <int Dof>
  void keep_off(State& state, double clearance);
  /// Least distance from what the bodies would touch (negative inside of it), at most `most`.
  double room(const State& state, double most);
  void forget_contacts();

  Scene scene_;
  MotionSpace space_;
  ContactOptions options_;
  double contact_depth_;
  ContactScene contact_scene_;
  std::unique_ptr<ContactScene> sensor_;  ///< sees penetration only; made when first asked for
  std::vector<ContactPoint> sensed_;      // scratch
  std::vector<MovingBody> bodies_;
  int per_body_ = 3;
  std::vector<Eigen::Vector3d> rest_hull_;  ///< corners of all fixed parts, world
  std::vector<Pose> poses_;                 // scratch
  std::vector<ContactPoint> touching_;      // at the state of the last update or follow
  std::vector<Pose> touching_at_;           // poses that touching_ belongs to; empty: to none
  double since_update_ = 0;                 // way since distances were asked for
  std::vector<ContactPoint> begin_touching_;
  std::vector<Pose> begin_at_;
  std::vector<ContactRow> begin_rows_;
  bool rows_current_ = false;     // rows_ were built from touching_ as it is
  std::vector<ContactRow> rows_;  // scratch
  RowMerger merger_;              // scratch
  RowColumns columns_;            // scratch of solvers
};

}  // namespace dismantle::sdf
