// run() and verify(), which release the interpreter's lock.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "bindings.h"
#include "dismantle/errors.h"
#include "held.h"
#include "interruptible.h"

namespace dismantle::python {
namespace {

/// A callback of the run. If it raises, the run is cancelled and the exception is raised when the run has ended.
class ProgressCallback {
 public:
  ProgressCallback(py::object function, CancelToken cancel)
      : function_(hold(std::move(function))),
        raised_(std::make_shared<std::optional<py::error_already_set>>()),
        cancel_(std::move(cancel)) {}

  void operator()(const ProgressEvent& event) const {
    py::gil_scoped_acquire lock;
    if (*raised_) return;
    try {
      (*function_)(py::str(event.phase.data(), event.phase.size()), event.done, event.total,
                   py::str(event.detail.data(), event.detail.size()));
    } catch (py::error_already_set& error) {
      raised_->emplace(error);
      cancel_.cancel();
    }
  }
  void rethrow() const {
    if (!*raised_) return;
    py::error_already_set error = **raised_;
    raised_->reset();
    throw py::error_already_set(error);
  }

 private:
  Held function_;
  std::shared_ptr<std::optional<py::error_already_set>> raised_;
  CancelToken cancel_;
};

HeldPlan plan(const HeldAssembly& loaded, const std::string& file, const std::vector<std::string>& overrides,
              const std::string& part, const py::object& on_progress, const py::object& should_stop) {
  const CancelToken cancel;
  std::optional<ProgressCallback> progress;
  if (!on_progress.is_none()) progress.emplace(on_progress, cancel);
  bool interrupted = false;
  const RunResult result = run_interruptible(
      cancel, should_stop, OnInterrupt::keep_results,
      [&] {
        const Session session = make_session(file, overrides);
        RunContext context = make_context(session, cancel);
        if (progress) context.on_progress = *progress;
        return session.plan(loaded, context, {.part = part});
      },
      &interrupted);
  if (progress) progress->rethrow();
  HeldPlan held{result.plan, {}};
  const auto set = [&](const char* name, auto value) { held.info[name] = py::cast(value); };
  set("outcome", result.outcome);
  set("interrupted", interrupted || cancel.cancelled());
  set("attempts", result.counts.attempts);
  set("memoised", result.counts.memoised);
  set("proposed", result.counts.proposed);
  set("refused", result.counts.refused);
  set("planner_counts", result.planner_counts);
  set("sequence_counts", result.sequence_counts);
  set("precedence", result.precedence);
  set("prepare_seconds", result.prepare_seconds);
  set("plan_seconds", result.plan_seconds);
  set("proof_seconds", result.proof_seconds);
  return held;
}

/// `given`: None, a path, or an Assembly. `tolerance`: assembly units; none: that of the plan.
PlanCheck verify(const HeldPlan& held, const py::object& given, std::optional<double> tolerance) {
  if (tolerance && !(*tolerance > 0)) throw py::value_error("tolerance: expected a number > 0, assembly units");
  std::string path = held.plan.assembly.source;
  std::shared_ptr<const std::vector<RawPart>> raw;
  std::string sha256;
  if (py::isinstance<HeldAssembly>(given)) {
    const auto& loaded = py::cast<const HeldAssembly&>(given);
    path = loaded.assembly->source;
    raw = loaded.raw;
    sha256 = loaded.assembly->sha256;
  } else if (!given.is_none()) {
    path = py::cast<std::string>(py::module_::import("os").attr("fspath")(given));
  }
  if (raw == nullptr && path.starts_with('<'))
    throw Error("the plan is for an assembly that was made in Python: give it as second argument");
  const CancelToken cancel;
  return run_interruptible(cancel, py::none(), OnInterrupt::raise, [&] {
    const Session session = Session::reader(make_registry());
    const RunContext context = make_context(session, cancel);
    const Assembly assembly = raw != nullptr
                                  ? session.assembly_of(held.plan, InputParts{*raw, sha256, {}, {}}, path, context)
                                  : session.assembly_of(held.plan, path, context);
    return session.verify(held.plan, assembly, context, {.tolerance = tolerance});
  });
}

}  // namespace

void bind_run(py::module_& m) {
  py::class_<PlanCheck>(m, "Verification", "What the verifier says of a plan.")
      .def_readonly("valid", &PlanCheck::valid,
                    "True when every step is a valid motion that separates what it says, or a forced one that cuts in "
                    "as deep as it "
                    "says, and every certificate holds.")
      .def_readonly("complete", &PlanCheck::complete,
                    "True when valid, no step is forced, and what was asked for is done.")
      .def_readonly(
          "forced", &PlanCheck::forced,
          "Number of steps that are forced: not valid motions, but what the plan says of their depth is true.")
      .def_readonly("certificates", &PlanCheck::certificates, "Number of certificates that hold.")
      .def_readonly("checked_by_prover", &PlanCheck::checked_by_prover,
                    "Of these: checked by the prover that made them, for want of an independent checker.")
      .def_readonly("verdicts", &PlanCheck::verdicts, "Number of verdicts of step checks that were judged again.")
      .def_readonly("not_checked", &PlanCheck::not_checked,
                    "List of str: step checks of the plan that are not available here, and why.")
      .def_readonly("max_penetration", &PlanCheck::max_penetration,
                    "Worst certified bound over all steps, above the initial overlap; assembly units.")
      .def_readonly("step_penetration", &PlanCheck::step_penetration, "The bound of each step.")
      .def_property_readonly(
          "problems",
          [](const PlanCheck& check) {
            std::vector<std::pair<unsigned, std::string>> out;
            for (const auto& p : check.problems) out.emplace_back(p.step, p.message);
            return out;
          },
          "What is wrong: list of (number of the step, message); step 0 = the plan as a whole.")
      .def("__bool__", [](const PlanCheck& check) { return check.valid; })
      .def("__repr__", [](const PlanCheck& check) {
        return fmt::format("<Verification: {}, {} problems>",
                           !check.valid       ? "not valid"
                           : check.complete   ? "valid and complete"
                           : check.forced > 0 ? "valid but for forced steps"
                                              : "valid, partial",
                           check.problems.size());
      });
  m.def("_run", &plan);
  m.def("_verify", &verify);
  m.def("_resolved", [](const std::string& file, const std::vector<std::string>& overrides, const std::string& folder) {
    py::gil_scoped_release release;
    return make_session(file, overrides).resolved(folder);
  });
}

}  // namespace dismantle::python
