/// Plugin types written in Python.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "dismantle/plugin.h"
#include "held.h"

namespace dismantle::python {

/// The declaration that the decorators of dismantle/_planners.py pass on.
struct PythonType {
  std::string id;
  Held cls;            ///< called with the parameters as keyword arguments
  Capabilities needs;  ///< path planners
  bool simultaneous_motion = false;
};

/// Registers `declared` (an object with the attributes id, cls, doc, source, version, file, needs, parameters) for all
/// later runs. `make` turns an object of its class into a plugin; it is called from any thread without the
/// interpreter's lock. @throws PluginError with all problems of the declaration.
using MakePlugin = std::shared_ptr<void> (*)(const PythonType& type, Held object);
void register_python_type(PluginKind kind, const py::object& declared, MakePlugin make);

/// A new object of the class. Call it without the interpreter's lock. @throws std::runtime_error with the traceback.
Held make_object(const PythonType& type, const ParamSet& values);

}  // namespace dismantle::python
