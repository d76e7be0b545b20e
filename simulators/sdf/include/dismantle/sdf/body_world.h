/// Common base of worlds of rigid bodies in contact, for any dynamics.
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

/// Parameters of contact detection and response.
struct ContactOptions {
  DistanceModel distance = DistanceModel::exact;
  bool surroundings = false;  ///< see ContactScene::see_surroundings
  double margin = 0.025;      ///< contacts with a smaller gap are listed
  double threshold = 0;       ///< depth allowed to all pairs
  double stiffness = 1e6;     ///< of a contact, N / unit
  double damping = 0;         ///< N s / unit^2
  double max_travel = 0.02;   ///< largest motion of a point by a correction
};

/// Keeps the contacts of the last queried state, answers queries that do not depend on dynamics, and corrects states in
/// place. A displacement x holds per body a shift and (rigid) a rotation vector about the centre, world axes.
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
  /// Depth error of contact, assembly units.
  double contact_depth() const { return contact_depth_; }
  Eigen::Index dof() const { return static_cast<Eigen::Index>(bodies_.size()) * per_body_; }
  const std::vector<ContactPoint>& touching() const { return touching_; }
  const std::vector<ContactRow>& rows() const { return rows_; }
  RowColumns& columns() { return columns_; }
  double deepest() const;  ///< of touching(), >= 0

  /// Finds contacts and rows at `state` and caches them, since the next advance() often begins there too. Returns false
  /// and does nothing if a number in state or action is not finite.
  /// @throws std::invalid_argument unless state and action have one entry per body.
  [[nodiscard]] bool begin(const State& state, const Action& action);
  /// Finds the contacts at `state`.
  void update_contacts(const State& state);
  /// Updates the contacts after a displacement `x` that moved no point by more than `travel`: with their linear model
  /// over short distances, else with distance queries.
  template <int Dof>
  void follow_contacts(const State& state, const typename StepSolver<Dof>::Vector& x, double travel);
  /// Builds the rows of touching(), with damping if `dt` > 0.
  void build_rows(const State& state, double dt);
  /// Moves the bodies; returns an upper bound of the motion of any point.
  template <int Dof>
  double displace(State& state, const typename StepSolver<Dof>::Vector& x) const;
  /// Upper bound of the motion of any point under `x`.
  template <int Dof>
  double travel_of(const typename StepSolver<Dof>::Vector& x) const;
  /// Displacement of a point (world) fixed to `body`; zero for body -1.
  template <int Dof>
  Eigen::Vector3d shift_of(int body, const Eigen::Vector3d& point, const State& state,
                           const typename StepSolver<Dof>::Vector& x) const;
  /// Pushes bodies out of surfaces in which they are deeper than `depth`. Needs the contacts of `state`, and updates
  /// them.
  template <int Dof>
  void settle(State& state, double depth);
  /// Isotropic weight matrix that penalises any displacement of the bodies.
  template <int Dof>
  typename StepSolver<Dof>::Matrix stay_put(double stiffness) const;

 private:
  template <int Dof>
  void keep_off(State& state, double clearance);
  /// Smallest gap of the contacts (negative: penetration), at most `most`.
  double room(const State& state, double most);
  void forget_contacts();

  Scene scene_;
  MotionSpace space_;
  ContactOptions options_;
  double contact_depth_;
  ContactScene contact_scene_;
  std::unique_ptr<ContactScene> sensor_;  ///< for penetration only; created on demand
  std::vector<ContactPoint> sensed_;      // scratch
  std::vector<MovingBody> bodies_;
  int per_body_ = 3;
  std::vector<Eigen::Vector3d> rest_hull_;  ///< corners of all fixed parts, world
  std::vector<Pose> poses_;                 // scratch
  std::vector<ContactPoint> touching_;      // at the state of the last update or follow_contacts()
  std::vector<Pose> touching_at_;           // poses of touching_; empty: invalid
  double since_update_ = 0;                 // motion since the last distance queries
  std::vector<ContactPoint> begin_touching_;
  std::vector<Pose> begin_at_;
  std::vector<ContactRow> begin_rows_;
  bool rows_current_ = false;     // rows_ match touching_
  std::vector<ContactRow> rows_;  // scratch
  RowMerger merger_;              // scratch
  RowColumns columns_;            // scratch of solvers
};

}  // namespace dismantle::sdf
