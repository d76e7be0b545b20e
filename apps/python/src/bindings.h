/// The functions that add the parts of the module, and shared declarations.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/host/registry.h"
#include "dismantle/importer.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"
#include "dismantle/session/session.h"

namespace dismantle::python {

namespace py = pybind11;

void bind_errors(py::module_& m);
void bind_assembly(py::module_& m);
void bind_step(py::module_& m);
void bind_unsolved(py::module_& m);
void bind_verdicts(py::module_& m);
void bind_plan(py::module_& m);
void bind_run(py::module_& m);
void bind_plugins(py::module_& m);
void bind_simulator(py::module_& m);
void bind_world(py::module_& m);
void bind_worlds(py::module_& m);
void bind_path_planner(py::module_& m);
void bind_sequence_planner(py::module_& m);
void bind_step_check(py::module_& m);
void bind_results(py::module_& m);

/// The assembly that Python holds.
struct HeldAssembly : LoadedAssembly {
  std::shared_ptr<const std::vector<RawPart>> raw{};  ///< parts of an assembly made in Python; null: read from files
};

/// The plan that Python holds. `info`: facts about the run that made it, by name; empty when it was read.
struct HeldPlan {
  Plan plan;
  std::map<std::string, py::object> info;
};

/// A scanned registry with the built-in plugins, those of $DISMANTLE_PLUGIN_PATH and load_plugin(), and the types
/// written in Python. Does not need the interpreter's lock.
std::shared_ptr<Registry> make_registry();

/// `file`: empty for none. `overrides`: KEY=VALUE each. As make_registry().
Session make_session(const std::string& file, const std::vector<std::string>& overrides);

/// Sends a log message to Python's logger "dismantle". May be called from any thread.
void log_to_python(LogLevel level, std::string_view text);

/// A context for one job of the calling thread.
RunContext make_context(const Session& session, const CancelToken& cancel);

/// Parts by name or number: a name, a number, or a sequence of these. @throws ValueError.
std::vector<PartId> part_ids(const Assembly& assembly, const py::handle& parts);

/// Converts a Python value to a parameter value. @throws TypeError.
ParamValue param_value(const ParamSpec& spec, const py::handle& value);
py::object python_value(const ParamValue& value);

}  // namespace dismantle::python
