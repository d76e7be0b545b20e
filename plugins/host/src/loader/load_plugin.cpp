#include "loader/load_plugin.h"

#include <cxxabi.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "loader/elf_file.h"
#include "loader/handshake.h"

namespace dismantle {
namespace {

bool word(const std::string& s) {
  if (s.empty() || s[0] < 'a' || s[0] > 'z') return false;
  return std::all_of(s.begin(), s.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; });
}

/// Words of lower-case letters, digits, '_' and '-', joined by dots.
bool good_id(const std::string& id) {
  std::size_t begin = 0;
  while (true) {
    const std::size_t dot = std::min(id.find('.', begin), id.size());
    if (!word(id.substr(begin, dot - begin))) return false;
    if (dot == id.size()) return true;
    begin = dot + 1;
  }
}

std::string demangled(const std::string& symbol) {
  int status = 0;
  char* text = ::abi::__cxa_demangle(symbol.c_str(), nullptr, nullptr, &status);
  const std::string result = status == 0 && text != nullptr ? text : symbol;
  std::free(text);
  return result;
}

/// The dynamic linker's message, C++ names made readable, the path (said already) left off.
std::string linker_message(const std::string& path) {
  const char* raw = dlerror();
  std::string text = raw != nullptr ? raw : "unknown error of the dynamic linker";
  if (text.starts_with(path + ": ")) text.erase(0, path.size() + 2);
  const std::string key = "undefined symbol: ";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) return "cannot be loaded: " + text;
  const std::size_t begin = at + key.size();
  const std::size_t end = std::min(text.find_first_of(" ,\t(", begin), text.size());
  return fmt::format(
      "cannot be loaded: undefined symbol {}; link the library that defines it, or rebuild the plugin "
      "against this Dismantle",
      demangled(text.substr(begin, end - begin)));
}

std::string joined(const std::vector<std::string>& parts) {
  std::string all;
  for (const auto& part : parts) all += (all.empty() ? "" : "; ") + part;
  return all;
}

}  // namespace

std::vector<std::string> problems_of_types(const std::vector<PluginType>& types, bool built_in) {
  std::vector<std::string> problems;
  std::set<std::string> ids;
  if (types.empty()) problems.emplace_back("registers no type: call r.add<...>(...) in the body of DISMANTLE_PLUGIN");
  for (const auto& type : types) {
    const auto add = [&](const std::string& problem) {
      problems.push_back(fmt::format("type '{}' {}", type.id, problem));
    };
    if (!good_id(type.id)) add("has a bad id: use lower-case words, joined by dots");
    const bool dotted = type.id.find('.') != std::string::npos;
    if (built_in && dotted) add("has a dot in its id: ids of built-in types are bare words");
    if (!built_in && !dotted)
      add(fmt::format("needs an id with a dot, such as 'acme.{}': bare ids belong to the built-in types", type.id));
    if (!ids.insert(type.id).second) add("is registered twice: give each type an id of its own");
    if (type.summary.empty()) add("has no summary: its second argument is one line for 'plugins list'");
    if (!type.create) add("cannot be made: it has no factory");
    for (const auto& problem : problems_of_schema(type.params)) add("has a bad declaration: " + problem);
  }
  return problems;
}

LoadedPlugin load_plugin(const std::filesystem::path& file, bool built_in) {
  LoadedPlugin plugin;
  PluginProblem so_far;
  so_far.file = file;
  const auto refuse = [&so_far](const std::string& message) {
    so_far.message = message;
    throw PluginRefused{so_far};
  };
  const std::string path = file.string();
  PluginHeader header;
  try {
    header = accept_header(read_elf_symbol(file, kPluginHeaderSymbol, sizeof(PluginHeader)), path);
  } catch (const PluginError& e) {
    const std::string what = e.what();
    refuse(what.starts_with(path + ": ") ? what.substr(path.size() + 2) : what);
  }
  so_far.plugin_id = header.id;

  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr) refuse(linker_message(path));
  const auto* loaded = static_cast<const PluginHeader*>(dlsym(library, kPluginHeaderSymbol));
  if (loaded == nullptr || loaded->register_types == nullptr) refuse("has no register function; rebuild the plugin");

  Registrar registrar;
  char message[1024] = {};
  if (loaded->register_types(&registrar, message, sizeof(message)) != 0) {
    message[sizeof(message) - 1] = '\0';
    refuse(fmt::format(
        "registration of plugin '{}' {} failed: {}; the plugin itself gave up, so its author has to say what it needs",
        header.id, header.version, message));
  }
  plugin.types = registrar.types();
  for (const auto& type : plugin.types) so_far.types.push_back(type.id);
  const auto problems = problems_of_types(plugin.types, built_in);
  if (!problems.empty()) refuse(joined(problems));

  plugin.file = {file, header.id, header.version, header.licence, header.url, built_in, so_far.types};
  return plugin;
}

}  // namespace dismantle
