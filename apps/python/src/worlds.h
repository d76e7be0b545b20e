/// Python view of many equal scenes that are stepped together.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "arrays.h"
#include "dismantle/executor.h"
#include "dismantle/simulator.h"

namespace dismantle::python {

/// Worlds with a current state each, on a pool of threads. What one world does depends neither on the others nor on the
/// number of threads. As with HeldWorld, reset() and setting a state begin with a new World. Call it with the
/// interpreter's lock, which is released during long work.
class HeldWorlds {
 public:
  using Make = std::function<std::unique_ptr<World>()>;
  /// `make` may be called without the interpreter's lock, from several threads. `count` and `threads` >= 1.
  HeldWorlds(Make make, std::size_t count, unsigned threads);

  std::size_t size() const { return worlds_.size(); }
  World& first() { return *worlds_.front().world; }
  /// `wrenches`: (N, M, 6), or (N, 6) for one moving part.
  std::vector<StepReport> step(const Array& wrenches, double duration, bool in_body_frame);
  /// `which`: numbers of worlds; None: all.
  void reset(const py::object& which);
  void set_state(std::size_t world, const Array& rows);
  Array states();                 ///< (N, M, 13)
  Array displacements();          ///< (N, M, 3): of the centres, from where they are assembled
  Array mean_normals();           ///< (N, M, 3): of the contacts; 0 without contact
  Array penetrations();           ///< (N,)
  py::array_t<bool> separated();  ///< (N,)

 private:
  struct One {
    std::unique_ptr<World> world;
    State state;
    std::vector<Contact> contacts{};  ///< buffer of mean_normals()
  };
  /// Calls work(One&, n) for the worlds without the interpreter's lock.
  template <class Work>
  void for_each(const std::vector<std::size_t>& which, Work work);
  std::vector<std::size_t> all() const;

  Make make_;
  std::size_t bodies_ = 0;
  std::vector<One> worlds_;
  Executor executor_;
  std::mutex mutex_;
};

}  // namespace dismantle::python
