/// What each unit adds to the module.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/host/config.h"
#include "dismantle/host/registry.h"
#include "dismantle/importer.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"

namespace dismantle::python {

namespace py = pybind11;

void bind_errors(py::module_& m);
void bind_assembly(py::module_& m);
void bind_step(py::module_& m);
void bind_unsolved(py::module_& m);
void bind_plan(py::module_& m);
void bind_run(py::module_& m);
void bind_plugins(py::module_& m);
void bind_simulator(py::module_& m);
void bind_world(py::module_& m);
void bind_path_planner(py::module_& m);
void bind_sequence_planner(py::module_& m);
void bind_results(py::module_& m);

/// The assembly that Python holds.
struct LoadedAssembly {
  std::shared_ptr<const Assembly> assembly;
  std::shared_ptr<const std::vector<RawPart>> raw;  ///< of one that was made in Python; null: it was read from files
  ParamSet options;                                 ///< the section `assembly:` that it was prepared with
  std::vector<std::string> flexible{};              ///< `constraints.flexible` that it was prepared with
  std::vector<NamedOverlap> declared{};             ///< `constraints.overlap` that it was prepared with
  std::vector<FlexiblePart> recognised{};           ///< parts that count as flexible by their shape and contact
};

/// The plan that Python holds. `info`: what is known of the run that made it, by name; empty when it was read.
struct HeldPlan {
  Plan plan;
  std::map<std::string, py::object> info;
};

/// A registry with the built-in plugins, those of $DISMANTLE_PLUGIN_PATH, of load_plugin(), and those that were written
/// in Python. Scanned. Needs no lock.
std::shared_ptr<Registry> make_registry();

/// `file`: empty for none. `overrides`: KEY=VALUE each.
ConfigSource config_source(const std::string& file, const std::vector<std::string>& overrides);

/// Log messages go to Python's logger "dismantle". Called from any thread.
void log_to_python(LogLevel level, std::string_view text);

/// For one job. The executor belongs to the calling thread. `threads` 0: all cores; `timeout` 0: none, seconds.
RunContext make_context(const CancelToken& cancel, unsigned threads = 0, double timeout = 0);

/// Parts by name or number: a name, a number, or a sequence of these. @throws ValueError.
std::vector<PartId> part_ids(const Assembly& assembly, const py::handle& parts);

/// A value for a parameter, from a Python value. @throws TypeError.
ParamValue param_value(const ParamSpec& spec, const py::handle& value);
py::object python_value(const ParamValue& value);

}  // namespace dismantle::python
