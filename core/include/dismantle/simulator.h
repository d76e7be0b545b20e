/// Physics or geometry backends.
///
/// Frames and units: assembly units, seconds, radians; world frame = assembled frame of the assembly. A part's pose
/// maps its assembled points to their current positions (pose.h).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/pose.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// What a moving part may do.
enum class MotionSpace {
  translation,  ///< R3: orientation is locked
  rigid,        ///< SE(3)
};

/// Facts about a simulator that can be queried before preparation.
struct Capabilities {
  bool dynamics = false;    ///< World::advance works
  bool contacts = false;    ///< World::contacts works
  bool distance = false;    ///< World::penetration tells free states from colliding ones without dynamics
  unsigned max_moving = 1;  ///< largest number of parts that may move simultaneously
};

/// A part, and where it is.
struct PlacedPart {
  PartId part = 0;
  Pose pose;
};

/// The parts of a world: `moving` are free, `fixed` do not move, all other parts are absent.
/// Moving parts start at the poses given here.
struct Scene {
  std::vector<PlacedPart> moving;
  std::vector<PlacedPart> fixed;
};

/// Velocity is that of the body's centre (see World::center), world axes.
struct BodyState {
  Pose pose;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< units / s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad / s
};

/// One entry per moving part, in the order of Scene::moving.
struct State {
  std::vector<BodyState> bodies;
};

/// Force and torque about the body's centre, world axes.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
};

/// One wrench per moving part.
struct Action {
  std::vector<Wrench> wrenches;
  bool in_body_frame = false;  ///< the wrenches turn with their bodies: given in the axes of the part, not of the world
};

/// One point of contact of a moving part with another part.
struct Contact {
  PartId moving = 0;
  PartId other = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< world
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, pushes `moving` away from `other`
  double depth = 0;                                  ///< > 0 = penetrating beyond what was there when assembled
  bool on_edge =
      false;  ///< at a convex edge or corner: the point is free as soon as it is outside one of the faces there
};

/// Poses along an advance, dense enough that the motion between two of them is a screw motion to
/// within the simulator's accuracy. One vector<Pose> per recorded instant, entries as Scene::moving.
using Trace = std::vector<std::vector<Pose>>;

/// What World::advance did.
struct StepReport {
  std::uint64_t steps = 0;  ///< time steps simulated
  double travel = 0;        ///< largest displacement of any point of a moving part, from begin to end pose
  bool stalled = false;     ///< stopped early: nothing moves any more under this action
  bool finite = true;       ///< false: the state diverged and was reset to the start
};

/// One scene: some parts move, others stay fixed. One world per thread; may be reused for many states.
class DISMANTLE_API World {
 public:
  virtual ~World();
  World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  virtual const Scene& scene() const = 0;
  virtual MotionSpace space() const = 0;
  /// State with every moving part where the scene put it, at rest.
  virtual State initial_state() const = 0;
  /// Centre of moving part `body` in its assembled frame, and the largest distance of its points from it.
  virtual Eigen::Vector3d center(std::size_t body) const = 0;
  virtual double radius(std::size_t body) const = 0;
  /// Factor that makes a wrench of unit force and of unit torque comparable for `body` (length, > 0).
  virtual double torque_arm(std::size_t body) const = 0;

  /// Simulate(s, a, dt) of Algorithm 1: applies the action for `duration` seconds. Appends poses to
  /// `trace` if given (begin excluded, end included). Stops early when stalled.
  /// Needs Capabilities::dynamics, else throws std::logic_error.
  virtual StepReport advance(State& state, const Action& action, double duration, Trace* trace = nullptr) = 0;
  /// Deepest penetration >= 0 of any pair above what was there when assembled.
  virtual double penetration(const State& state) = 0;
  /// Moves the bodies, by as little as it takes, so that they keep `clearance` (assembly units, small) from other
  /// parts, or half of the gap where it is narrow. A world without this ability leaves the state unchanged.
  virtual void project_to_clearance(State& state, double clearance) { (void)state, (void)clearance; }
  /// Replaces the content of `out`.
  virtual void contacts(const State& state, std::vector<Contact>& out) = 0;
  /// True when the hulls of all moving parts together are apart from the hull of all fixed parts (section 3). True when
  /// nothing is fixed.
  virtual bool separated(const State& state) = 0;
  /// True when the hull of moving part `body` alone is apart from the hull of all others, moving and fixed. The default
  /// is separated() if one part moves and throws std::logic_error otherwise; worlds with several moving parts override
  /// it.
  virtual bool body_separated(const State& state, std::size_t body);
  /// Reports a point where the verifier found the world too permissive: `point` (assembled frame of `part`) lay inside
  /// `other`. A world that samples contact adds it; others may ignore it.
  virtual void add_contact_sample(PartId part, PartId other, const Eigen::Vector3d& point) = 0;
  /// True while the world allows the initial overlap of a pair only where it is when assembled. The verifier allows
  /// that depth everywhere (unless the pair has an overlap region); a stricter world finds better paths at first.
  virtual bool overlap_is_local() const { return false; }
  /// From now on the world allows the initial overlap of a pair everywhere, as the verifier does.
  virtual void allow_overlap_everywhere() {}
};

/// Data that a simulator computes once for an assembly (fields, hierarchies, hulls). Immutable, shared by threads.
class DISMANTLE_API PreparedAssembly {
 public:
  virtual ~PreparedAssembly();
};

/// Stateless factory; parameters are fixed at construction. Safe to call from several threads.
class DISMANTLE_API Simulator {
 public:
  virtual ~Simulator();
  virtual Capabilities capabilities() const noexcept = 0;
  /// `tolerance`: penetration above the initial overlap that the verifier tolerates, assembly units. A run calls this
  /// when it first needs a world; without a search, never.
  /// @throws InputError naming the part that cannot be used.
  virtual std::shared_ptr<const PreparedAssembly> prepare(const Assembly& assembly, double tolerance,
                                                          RunContext& context) = 0;
  /// The assembly given to prepare() and `prepared` must outlive the world.
  virtual std::unique_ptr<World> world(const Assembly& assembly, const PreparedAssembly& prepared, const Scene& scene,
                                       MotionSpace space) const = 0;
};

}  // namespace dismantle
