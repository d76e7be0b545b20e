// The module dismantle._core, the compiled part of the package `dismantle`.
#include <pybind11/pybind11.h>

#include "bindings.h"

PYBIND11_MODULE(_core, m) {
  using namespace dismantle::python;
  m.doc() = "Compiled part of the package dismantle.";
  m.attr("__version__") = DISMANTLE_VERSION;
  bind_errors(m);
  bind_assembly(m);
  bind_plan(m);
  bind_plugins(m);
  bind_run(m);
  bind_world(m);
  bind_worlds(m);
  bind_simulator(m);
  bind_path_planner(m);
  bind_sequence_planner(m);
  bind_step_check(m);
  bind_results(m);
}
