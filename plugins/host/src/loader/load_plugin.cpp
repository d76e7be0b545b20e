#include "loader/load_plugin.h"

#include <cxxabi.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>
#include <string_view>

#include "loader/elf_file.h"
#include "loader/handshake.h"

namespace dismantle {
namespace {

bool word(const std::string& s) {
  if (s.empty() || s[0] < 'a' || s[0] > 'z') return false;
  return std::all_of(s.begin(), s.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; });
}

/// True for words of lower-case letters, digits, '_' and '-', joined by dots.
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

/// The dynamic linker's message with demangled C++ names and without the path, which the caller adds.
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

std::vector<std::string> problems_of_ids(const std::vector<OfferedType>& types, bool built_in) {
  std::vector<std::string> problems;
  std::set<std::string> ids;
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
  }
  return problems;
}

/// Parses "KIND ID, KIND ID". Nothing when the text has another form.
std::optional<std::vector<OfferedType>> read_offers(std::string_view text) {
  std::vector<OfferedType> offers;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const std::string_view one = text.substr(0, comma);
    const std::size_t blank = one.find(' ');
    const auto* kind = std::find_if(std::begin(kPluginKinds), std::end(kPluginKinds),
                                    [&](PluginKind k) { return to_string(k) == one.substr(0, blank); });
    if (blank == std::string_view::npos || kind == std::end(kPluginKinds)) return std::nullopt;
    offers.push_back({*kind, std::string(one.substr(blank + 1))});
    text.remove_prefix(std::min(comma + 1, text.size()));
    while (text.starts_with(' ')) text.remove_prefix(1);
  }
  return offers;
}

std::string text_of(const std::vector<OfferedType>& offers) {
  std::string text;
  for (const auto& type : offers)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", to_string(type.kind), type.id);
  return text;
}

std::vector<std::string> ids_of(const std::vector<OfferedType>& offers) {
  std::vector<std::string> ids;
  for (const auto& type : offers) ids.push_back(type.id);
  return ids;
}

}  // namespace

std::vector<OfferedType> offers_of(const std::vector<PluginType>& types) {
  std::vector<OfferedType> offers;
  for (const auto& type : types) offers.push_back({type.kind, type.id});
  return offers;
}

std::vector<std::string> problems_of_types(const std::vector<PluginType>& types, bool built_in) {
  std::vector<std::string> problems = problems_of_ids(offers_of(types), built_in);
  if (types.empty()) problems.emplace_back("registers no type: call r.add<...>(...) in the body of DISMANTLE_PLUGIN");
  for (const auto& type : types) {
    const auto add = [&](const std::string& problem) {
      problems.push_back(fmt::format("type '{}' {}", type.id, problem));
    };
    if (type.summary.empty()) add("has no summary: its second argument is one line for 'plugins list'");
    if (!type.create) add("cannot be made: it has no factory");
    for (const auto& problem : problems_of_schema(type.params)) add("has a bad declaration: " + problem);
  }
  return problems;
}

OfferedPlugin read_plugin(const std::filesystem::path& file, bool built_in) {
  PluginProblem so_far;
  so_far.file = file;
  const auto refuse = [&so_far](const std::string& message) {
    so_far.message = message;
    throw PluginRefused{so_far};
  };
  const std::string path = file.string();
  PluginHeader header;
  std::string types;
  try {
    ElfFile elf(file);
    const auto bytes = elf.symbol(kPluginHeaderSymbol, sizeof(PluginHeader));
    if (!bytes)
      throw PluginError(path, fmt::format("has no symbol '{}': it is a shared library, but no Dismantle plugin (or the "
                                          "plugin lacks DISMANTLE_PLUGIN)",
                                          kPluginHeaderSymbol));
    header = accept_header(*bytes, path);
    // Optional: all types of the plugin in order of registration, as "KIND ID" separated by commas
    // (cmake/DismantlePlugin.cmake).
    if (const auto text = elf.symbol("dismantle_plugin_types", 65536)) types.assign(text->begin(), text->end());
    types.resize(std::min(types.find('\0'), types.size()));
  } catch (const PluginError& e) {
    const std::string what = e.what();
    refuse(what.starts_with(path + ": ") ? what.substr(path.size() + 2) : what);
  }
  so_far.plugin_id = header.id;
  OfferedPlugin plugin{{file, header.id, header.version, header.licence, header.url, built_in, {}}, {}};
  const auto offers = read_offers(types);
  if (!offers) refuse(fmt::format("'{}' is no list of types, such as 'path_planner acme.rrt'", types));
  plugin.types = *offers;
  plugin.file.types = so_far.types = ids_of(plugin.types);
  const auto problems = problems_of_ids(plugin.types, built_in);
  if (!problems.empty()) refuse(joined(problems));
  return plugin;
}

LoadedPlugin load_plugin(const OfferedPlugin& offered) {
  LoadedPlugin plugin{offered.file, {}};
  PluginProblem so_far{offered.file.path, offered.file.id, offered.file.types, {}};
  const auto refuse = [&so_far](const std::string& message) {
    so_far.message = message;
    throw PluginRefused{so_far};
  };
  const std::string path = offered.file.path.string();
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
        offered.file.id, offered.file.version, message));
  }
  plugin.types = registrar.types();
  const auto registered = offers_of(plugin.types);
  plugin.file.types = ids_of(registered);
  for (const auto& id : plugin.file.types)
    if (std::ranges::find(so_far.types, id) == so_far.types.end()) so_far.types.push_back(id);
  const auto problems = problems_of_types(plugin.types, offered.file.built_in);
  if (!problems.empty()) refuse(joined(problems));
  if (!offered.types.empty() && registered != offered.types)
    refuse(fmt::format("registers '{}', but its list of types is '{}'; both must be the same", text_of(registered),
                       text_of(offered.types)));
  return plugin;
}

}  // namespace dismantle
