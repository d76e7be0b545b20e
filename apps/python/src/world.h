/// A simulated scene, as Python sees it.
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

/// Work that worlds have done for one query.
struct Work {
  std::uint64_t steps = 0, state_checks = 0;
};

/// Answer of HeldWorld::step().
struct StepOutcome {
  StepReport report;
  Trace trace;
  std::size_t bodies = 0;
};

struct ContactList {
  std::vector<Contact> contacts;
};

/// A world with a current state. A World remembers what it measured, which changes later answers in their last bits:
/// here each reset() and each state that is set begins with a new one, so that the same calls give the same bits.
/// Called with the interpreter's lock, which is released for long work; the mutex then keeps other threads out.
class HeldWorld {
 public:
  using Make = std::function<std::unique_ptr<World>()>;
  /// `make`: makes the world anew, always the same; keeps alive what the world refers to. `work` may be null.
  /// May be called without the interpreter's lock.
  HeldWorld(std::shared_ptr<const Assembly> assembly, Make make, std::shared_ptr<Work> work);
  /// From now on every use raises: the query that the world was made for is over.
  void close();

  const Assembly& assembly() const { return *assembly_; }
  std::size_t bodies() const { return bodies_; }
  const State& state() const { return state_; }
  void set_state(const Array& rows);
  void set_poses(const Array& rows);
  void reset();
  Array state_rows() const;
  /// `wrench`: (6,) for one moving part, (M, 6).
  StepOutcome step(const Array& wrench, double duration, bool in_body_frame);
  double penetration(const py::object& poses);
  ContactList contacts(const py::object& poses);
  bool separated(const py::object& poses);
  bool body_separated(std::size_t body);
  void project_to_clearance(double clearance);
  void add_contact_sample(PartId part, PartId other, const Eigen::Vector3d& point);
  void allow_overlap_everywhere();
  /// For what is quick. @throws Error when closed.
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
  std::vector<Sample> samples_;  ///< that were added, for the next world
  bool overlap_everywhere_ = false;
  std::mutex mutex_;
};

/// "translation" or "rigid". @throws ValueError.
MotionSpace motion_space(const std::string& text);

}  // namespace dismantle::python
