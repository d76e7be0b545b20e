#include "plugin_template.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <system_error>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/host/registry.h"
#include "dismantle/host/suggest.h"
#include "dismantle/plan_io/read_file.h"

namespace dismantle::app {
namespace {

namespace fs = std::filesystem;

/// "acme.in_turn" -> "acme_in_turn": names of files, targets, macros.
std::string identifier(std::string id) {
  std::replace(id.begin(), id.end(), '.', '_');
  return id;
}

/// "acme.in_turn" -> "AcmeInTurn": name of the class.
std::string class_name(const std::string& id) {
  std::string name;
  bool begins = true;
  for (const char c : id) {
    if (c == '.' || c == '_') {
      begins = true;
      continue;
    }
    name += begins && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    begins = false;
  }
  return name;
}

void check_id(const std::string& id) {
  bool good = id.find('.') != std::string::npos;
  bool begins = true;  // of a word
  for (const char c : id) {
    const bool letter = c >= 'a' && c <= 'z', more = (c >= '0' && c <= '9') || c == '_';
    good = good && (begins ? letter : letter || more || c == '.');
    begins = c == '.';
  }
  if (good && !begins) return;
  throw Error(fmt::format(
      "'{}' cannot be the name of a plugin: a name is two or more words joined by dots, each of lower-case letters, "
      "digits and '_', as in acme.rrt",
      id));
}

/// Replaces names such as "AcmeLines" -> "FooBar" in a text or a file name.
class Renaming {
 public:
  Renaming(const std::string& from, const std::string& to) { add(from, to); }
  void add(const std::string& from, const std::string& to) {
    pairs_.emplace_back(from, to);
    pairs_.emplace_back(identifier(from), identifier(to));
    pairs_.emplace_back(class_name(from), class_name(to));
  }
  /// Replaces in one pass, so that inserted names are not replaced again.
  std::string operator()(const std::string& text) const {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
      const auto found = std::find_if(pairs_.begin(), pairs_.end(), [&](const auto& pair) {
        return text.compare(at, pair.first.size(), pair.first) == 0;
      });
      if (found == pairs_.end()) {
        out += text[at++];
        continue;
      }
      out += found->second;
      at += found->first.size();
    }
    return out;
  }

 private:
  std::vector<std::pair<std::string, std::string>> pairs_;
};

/// The id of the plugin in a template: "acme.in_turn" of the file acme_in_turn.cpp.
std::string id_of_template(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".cpp" || name.ends_with("_test")) continue;
    name[name.find('_')] = '.';
    return name;
  }
  throw Error(folder.string() + ": holds no template");
}

void open_project_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  if (!fs::is_directory(folder, error)) throw Error(folder.string() + ": is no folder");
  if (!fs::is_empty(folder, error))
    throw Error(folder.string() + ": holds files already; name a folder that is new or empty");
}

/// Copies one folder of templates.
void copy(const fs::path& from, const fs::path& to, const Renaming& renamed, std::vector<std::string>& written) {
  for (const auto& entry : fs::recursive_directory_iterator(from)) {
    if (!entry.is_regular_file()) continue;
    fs::path place;
    for (const fs::path& name : fs::relative(entry.path(), from)) {
      const std::string word = renamed(name.string());
      const std::string_view hidden = "dot_";  // prefix of template files whose copies are hidden
      place /= word.starts_with(hidden) ? "." + word.substr(hidden.size()) : word;
    }
    fs::create_directories((to / place).parent_path());
    std::ofstream out(to / place, std::ios::binary);
    out << renamed(read_file(entry.path()));
    out.close();
    if (!out) throw Error((to / place).string() + ": cannot be written");
    written.push_back(place.string());
  }
}

}  // namespace

std::vector<std::string> template_kinds() {
  std::vector<std::string> kinds;
  for (const PluginKind kind : kPluginKinds) kinds.emplace_back(to_string(kind));
  return kinds;
}

std::vector<std::string> write_plugin_project(const fs::path& folder, const std::string& kind, const std::string& id) {
  const auto kinds = template_kinds();
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) {
    const auto near = nearest(kind, kinds);
    throw Error(fmt::format("there is no template for a '{}'{}; there are templates for {}", kind,
                            near ? fmt::format(", did you mean '{}'?", *near) : "", fmt::join(kinds, ", ")));
  }
  check_id(id);
  const fs::path templates =
      (fs::read_symlink("/proc/self/exe").parent_path() / DISMANTLE_TEMPLATES).lexically_normal();
  std::error_code error;
  if (!fs::is_directory(templates / kind, error))
    throw Error(fmt::format("{}: the templates are not there; they are installed with Dismantle (cmake --install)",
                            (templates / kind).string()));
  open_project_folder(folder);
  Renaming renamed(id_of_template(templates / kind), id);
  renamed.add("acme.example", id);  // the id in the files that all kinds share
  std::vector<std::string> written;
  copy(templates / "common", folder, renamed, written);
  copy(templates / kind, folder, renamed, written);
  std::sort(written.begin(), written.end());
  return written;
}

}  // namespace dismantle::app
