#include "python_type.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <stdexcept>

#include "bindings.h"
#include "dismantle/host/registry.h"

namespace dismantle::python {
namespace {

std::optional<double> bound(const py::object& value) {
  if (value.is_none()) return std::nullopt;
  return py::cast<double>(value);
}

ParamSpec spec_of(const py::handle& declared) {
  ParamSpec spec;
  spec.name = py::cast<std::string>(declared.attr("name"));
  spec.unit = py::cast<std::string>(declared.attr("unit"));
  spec.doc = py::cast<std::string>(declared.attr("doc"));
  spec.min = bound(declared.attr("min"));
  spec.max = bound(declared.attr("max"));
  spec.min_open = py::cast<bool>(declared.attr("min_open"));
  spec.max_open = py::cast<bool>(declared.attr("max_open"));
  spec.advanced = py::cast<bool>(declared.attr("advanced"));
  const py::object fallback = declared.attr("default");
  const py::dict choices = declared.attr("choices");
  for (const auto& [name, doc] : choices)
    spec.choices.push_back({py::cast<std::string>(name), py::cast<std::string>(doc)});
  if (!choices.empty()) {
    spec.type = ParamType::choice;
  } else if (py::isinstance<py::bool_>(fallback)) {
    spec.type = ParamType::boolean;
  } else if (py::isinstance<py::int_>(fallback)) {
    spec.type = ParamType::integer;
  } else if (py::isinstance<py::float_>(fallback)) {
    spec.type = ParamType::number;
  } else if (py::isinstance<py::str>(fallback)) {
    spec.type = ParamType::text;
  } else {
    throw py::type_error(fmt::format("parameter '{}': its default has to be a bool, int, float or str; got {}",
                                     spec.name, py::cast<std::string>(py::repr(fallback))));
  }
  spec.fallback = param_value(spec, fallback);
  return spec;
}

Capabilities needs_of(const py::object& words) {
  Capabilities needs;
  for (const py::handle word : py::cast<py::iterable>(words)) {
    const auto text = py::cast<std::string>(word);
    if (text == "dynamics") {
      needs.dynamics = true;
    } else if (text == "contacts") {
      needs.contacts = true;
    } else if (text == "distance") {
      needs.distance = true;
    } else {
      throw py::value_error(
          fmt::format("needs: '{}' is not a capability; there are 'dynamics', 'contacts', 'distance'", text));
    }
  }
  return needs;
}

}  // namespace

Held make_object(const PythonType& type, const ParamSet& values) {
  py::gil_scoped_acquire lock;
  try {
    py::dict arguments;
    for (const auto& [name, value] : values) arguments[py::str(name)] = python_value(value);
    return hold((*type.cls)(**arguments));
  } catch (py::error_already_set& error) {
    throw std::runtime_error(traceback_of(error));
  }
}

void register_python_type(PluginKind kind, const py::object& declared, MakePlugin make) {
  PluginType type;
  type.kind = kind;
  type.id = py::cast<std::string>(declared.attr("id"));
  type.summary = py::cast<std::string>(declared.attr("doc"));
  type.traits.source = py::cast<std::string>(declared.attr("source"));
  type.traits.needs = needs_of(declared.attr("needs"));
  for (const py::handle parameter : py::cast<py::iterable>(declared.attr("parameters")))
    type.params.push_back(spec_of(parameter));
  const PythonType python{type.id, hold(declared.attr("cls")), type.traits.needs,
                          py::cast<bool>(declared.attr("simultaneous_motion"))};
  type.create = [python, make](const ParamSet& values, const PluginMaker&) {
    return make(python, make_object(python, values));
  };
  PluginFile file;
  file.path = py::cast<std::string>(declared.attr("file"));
  file.id = type.id;
  file.version = py::cast<std::string>(declared.attr("version"));
  add_program_type(std::move(file), std::move(type));
}

}  // namespace dismantle::python
