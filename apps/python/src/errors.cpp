// Translates exceptions of the core to those of dismantle/_errors.py.
#include "dismantle/errors.h"

#include <pybind11/stl.h>

#include <filesystem>

#include "bindings.h"

namespace dismantle::python {
namespace {

/// Sets a dismantle._errors.NAME(message) with these attributes as the Python error.
void raise(const char* name, const char* what, const py::dict& attributes) {
  const py::object type = py::module_::import("dismantle._errors").attr(name);
  const py::object error = type(py::str(what));
  for (const auto& [key, value] : attributes) py::setattr(error, key, value);
  PyErr_SetObject(type.ptr(), error.ptr());
}

}  // namespace

void bind_errors(py::module_&) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const ConfigError& e) {
      py::list diagnostics;
      const py::object diagnostic = py::module_::import("dismantle._errors").attr("Diagnostic");
      for (const Diagnostic& d : e.diagnostics()) diagnostics.append(diagnostic(d.file, d.line, d.column, d.message));
      raise("ConfigError", e.what(), py::dict(py::arg("diagnostics") = diagnostics));
    } catch (const InputError& e) {
      raise("InputError", e.what(), py::dict(py::arg("subject") = e.subject()));
    } catch (const PluginError& e) {
      raise("PluginError", e.what(), py::dict(py::arg("file") = e.file()));
    } catch (const Error& e) {
      raise("Error", e.what(), py::dict());
    } catch (const std::filesystem::filesystem_error& e) {
      PyErr_SetString(PyExc_OSError, e.what());
    }
  });
}

}  // namespace dismantle::python
