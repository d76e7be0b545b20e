// Plugins: listing them, loading files, and registering types written in Python.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <mutex>

#include "bindings.h"
#include "dismantle/errors.h"
#include "dismantle/host/describe.h"

namespace dismantle::python {
namespace {

std::mutex g_files_mutex;
std::vector<std::filesystem::path>& loaded_files() {
  static std::vector<std::filesystem::path> files;
  return files;
}

py::object load_plugin(const std::filesystem::path& file) {
  Registry registry;
  registry.scan();
  const PluginFile& loaded = registry.load(file);
  const std::lock_guard lock(g_files_mutex);
  loaded_files().push_back(loaded.path);
  return py::cast(loaded.types);
}

/// Descriptions of all types, or of the one with that id, as JSON texts.
std::vector<std::string> descriptions(const std::string& id) {
  const auto registry = make_registry();
  std::vector<std::string> out;
  if (!id.empty()) return {describe_json(registry->find(id), *registry)};
  for (const PluginKind kind : kPluginKinds)
    for (const RegisteredType* type : registry->types(kind)) out.push_back(describe_json(*type, *registry));
  return out;
}

std::vector<std::pair<std::string, std::string>> problems() {
  std::vector<std::pair<std::string, std::string>> out;
  for (const auto& p : make_registry()->problems()) out.emplace_back(p.file.string(), p.message);
  return out;
}

}  // namespace

std::shared_ptr<Registry> make_registry() {
  auto registry = std::make_shared<Registry>();
  {
    const std::lock_guard lock(g_files_mutex);
    for (const auto& file : loaded_files()) registry->add_search_path(file);
  }
  registry->scan();
  return registry;
}

Session make_session(const std::string& file, const std::vector<std::string>& overrides) {
  ConfigSource source;
  if (!file.empty()) source.file = file;
  source.set = overrides;
  Session session(source, make_registry());
  for (const auto& warning : session.config().warnings) log_to_python(LogLevel::warning, warning);
  return session;
}

void log_to_python(LogLevel level, std::string_view text) {
  if (Py_IsInitialized() == 0) return;
  py::gil_scoped_acquire lock;
  const char* method = level == LogLevel::debug     ? "debug"
                       : level == LogLevel::info    ? "info"
                       : level == LogLevel::warning ? "warning"
                                                    : "error";
  try {
    const py::object logger = py::module_::import("logging").attr("getLogger")("dismantle");
    logger.attr(method)("%s", py::str(text.data(), text.size()));
  } catch (py::error_already_set& error) {
    error.discard_as_unraisable("logging of dismantle");
  }
}

RunContext make_context(const Session& session, const CancelToken& cancel) {
  RunContext context = session.context();
  context.cancel = cancel;
  context.on_log = log_to_python;
  return context;
}

ParamValue param_value(const ParamSpec& spec, const py::handle& value) {
  const auto fail = [&](const char* expected) {
    throw py::type_error(
        fmt::format("{}: expected {}, got {}", spec.name, expected, py::cast<std::string>(py::repr(value))));
  };
  switch (spec.type) {
    case ParamType::boolean:
      if (!py::isinstance<py::bool_>(value)) fail("True or False");
      return py::cast<bool>(value);
    case ParamType::integer:
      if (py::isinstance<py::bool_>(value) || PyIndex_Check(value.ptr()) == 0) fail("an integer");
      return py::cast<std::int64_t>(py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr())));
    case ParamType::number:
      if (py::isinstance<py::bool_>(value) || PyNumber_Check(value.ptr()) == 0) fail("a number");
      return py::cast<double>(py::float_(py::reinterpret_borrow<py::object>(value)));
    case ParamType::text:
    case ParamType::choice:
      if (!py::isinstance<py::str>(value)) fail("a string");
      return py::cast<std::string>(value);
    case ParamType::plugin:
    case ParamType::plugins:
      break;
  }
  fail("a plain value; plugins inside of plugins are chosen in a configuration");
  return {};
}

py::object python_value(const ParamValue& value) {
  if (const auto* b = std::get_if<bool>(&value)) return py::bool_(*b);
  if (const auto* i = std::get_if<std::int64_t>(&value)) return py::int_(*i);
  if (const auto* d = std::get_if<double>(&value)) return py::float_(*d);
  if (const auto* s = std::get_if<std::string>(&value)) return py::str(*s);
  return py::str(to_text(value));
}

void bind_plugins(py::module_& m) {
  m.def("load_plugin", &load_plugin, py::arg("path"),
        "Loads a plugin file (a shared library). Returns the ids of its types. Raises PluginError saying why it is "
        "refused.");
  m.def("_kinds", [] {
    std::vector<std::string> kinds;
    for (const PluginKind kind : kPluginKinds) kinds.emplace_back(to_string(kind));
    return kinds;
  });
  m.def("_descriptions", &descriptions, py::call_guard<py::gil_scoped_release>());
  m.def("plugin_problems", &problems, py::call_guard<py::gil_scoped_release>(),
        "Plugin files that were found and not used: list of (file, what is wrong).");
}

}  // namespace dismantle::python
