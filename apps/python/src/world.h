/// A simulated scene, as Python sees it.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <string>

#include "arrays.h"
#include "dismantle/simulator.h"

namespace dismantle::python {

/// Work that worlds have done for one query.
struct Work {
  std::uint64_t steps = 0, state_checks = 0;
};

/// A world with a current state. Used by one thread at a time; the mutex keeps others out while the interpreter's lock
/// is released.
class HeldWorld {
 public:
  /// `keep`: what the world refers to, in the order in which it is to be dropped last. `work` may be null.
  HeldWorld(std::shared_ptr<const Assembly> assembly, std::shared_ptr<void> keep, std::unique_ptr<World> world,
            std::shared_ptr<Work> work);
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
  py::object step(const Array& wrench, double duration, bool in_body_frame);
  double penetration(const py::object& poses);
  py::object contacts(const py::object& poses);
  bool separated(const py::object& poses);
  bool body_separated(std::size_t body);
  World& world();

 private:
  State state_at(const py::object& poses) const;

  std::shared_ptr<void> keep_;
  std::shared_ptr<const Assembly> assembly_;
  std::unique_ptr<World> world_;
  std::shared_ptr<Work> work_;
  std::size_t bodies_;
  State state_;
  std::mutex mutex_;
};

/// "translation" or "rigid". @throws ValueError.
MotionSpace motion_space(const std::string& text);

}  // namespace dismantle::python
