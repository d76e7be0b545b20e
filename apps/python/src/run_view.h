/// Python view of a RunContext.
#pragma once

#include <pybind11/pybind11.h>

#include "dismantle/run_context.h"

namespace dismantle::python {

namespace py = pybind11;

/// Valid until the planner returns.
class RunView {
 public:
  explicit RunView(RunContext& context) : context_(&context) {}
  void close() { context_ = nullptr; }
  RunContext& context() const;
  /// numpy.random.Generator, seeded from the run's generator; one per call of the planner.
  py::object rng();

 private:
  RunContext* context_;
  py::object rng_;
};

void bind_run_view(py::module_& m);

}  // namespace dismantle::python
