#include "run_view.h"

#include <memory>
#include <string>

#include "dismantle/errors.h"

namespace dismantle::python {

RunContext& RunView::context() const {
  if (context_ == nullptr) throw Error("this context belongs to a call of a planner that is over");
  return *context_;
}

py::object RunView::rng() {
  if (!rng_) rng_ = py::module_::import("numpy").attr("random").attr("default_rng")(context().rng.next());
  return rng_;
}

void bind_run_view(py::module_& m) {
  py::class_<RunView, std::shared_ptr<RunView>>(
      m, "RunContext",
      "Time, cancellation, random numbers and log of a run. Valid until the planner "
      "returns.")
      .def(
          "should_stop", [](const RunView& v) { return v.context().should_stop(); },
          "True when time is up or the user asked to stop. Ask it at least every tenth of a second.")
      .def_property_readonly(
          "cancelled", [](const RunView& v) { return v.context().cancel.cancelled(); },
          "True when the user asked to stop.")
      .def_property_readonly(
          "seconds_left", [](const RunView& v) { return v.context().deadline.seconds_left(); },
          "Seconds until the deadline; inf when there is none.")
      .def_property_readonly(
          "rng", &RunView::rng,
          "numpy.random.Generator. The only source of random numbers with which the same seed gives the "
          "same plan.")
      .def(
          "log",
          [](const RunView& v, const std::string& text) {
            const RunContext context = v.context();
            py::gil_scoped_release release;
            context.log(LogLevel::info, text);
          },
          py::arg("text"), "Writes a line to the log of the run (Python: logger 'dismantle', level info).");
}

}  // namespace dismantle::python
