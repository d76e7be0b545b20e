/// Python view of a simulated scene.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "arrays.h"
#include "dismantle/simulator.h"

namespace dismantle::python {

/// The effort of worlds for one query.
struct Work {
  std::uint64_t steps = 0, state_checks = 0;
};

/// Result of HeldWorld::step().
struct StepOutcome {
  StepReport report;
  Trace trace;
  std::size_t bodies = 0;
};

struct ContactList {
  std::vector<Contact> contacts;
};

/// A world with a current state. A World caches measurements, which changes the last bits of later answers. Therefore
/// reset() and setting a state begin with a new World, so that equal calls give equal bits.
/// Call it with the interpreter's lock. Long work releases that lock; the mutex then excludes other threads.
class HeldWorld {
 public:
  using Make = std::function<std::unique_ptr<World>()>;
  /// `make`: makes an identical new world and keeps alive all that it refers to. `work` may be null. May be called
  /// without the interpreter's lock.
  HeldWorld(std::shared_ptr<const Assembly> assembly, Make make, std::shared_ptr<Work> work);
  /// Makes every later use raise, because the query of this world has ended.
  void close();

  const Assembly& assembly() const { return *assembly_; }
  std::size_t bodies() const { return bodies_; }
  const State& state() const { return state_; }
  void set_state(const Array& rows);
  void set_poses(const Array& rows);
  void reset();
  Array state_rows() const;
  /// `wrench`: (M, 6), or (6,) for one moving part.
  StepOutcome step(const Array& wrench, double duration, bool in_body_frame);
  double penetration(const py::object& poses);
  ContactList contacts(const py::object& poses);
  bool separated(const py::object& poses);
  bool body_separated(std::size_t body);
  void project_to_clearance(double clearance);
  void add_contact_sample(PartId part, PartId other, const Eigen::Vector3d& point);
  void allow_overlap_everywhere();
  /// The world, for fast calls that keep the interpreter's lock. @throws Error when closed.
  World& world();
  /// As world(). @throws py::index_error.
  World& world_with_body(std::size_t body);

 private:
  struct Sample {
    PartId part, other;
    Eigen::Vector3d point;
  };
  State state_at(const py::object& poses) const;
  void begin_anew(State state);
  /// Calls `work(world, state)` without the interpreter's lock; the state may be changed.
  template <class Do>
  auto at(State& state, Do work);

  std::shared_ptr<const Assembly> assembly_;
  Make make_;
  std::unique_ptr<World> world_;  ///< null: closed
  std::shared_ptr<Work> work_;
  std::size_t bodies_;
  State state_;
  std::vector<Sample> samples_;  ///< samples added so far, to be added to each new world
  bool overlap_everywhere_ = false;
  std::mutex mutex_;
};

/// Numbers per body of a state: position (3), quaternion (4), velocity (3), angular velocity (3).
inline constexpr std::size_t kStateColumns = 13;
/// Writes the numbers of `body` to `to`; returns where the next ones go.
double* write_state(const BodyState& body, double* to);
/// The state of rows (M, 13), or (13,) for one moving part. @throws ValueError.
State state_of(const Array& rows, std::size_t bodies);

/// "translation" or "rigid". @throws ValueError.
MotionSpace motion_space(const std::string& text);

}  // namespace dismantle::python
