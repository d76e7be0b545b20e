#include "library.h"

#include <fmt/format.h>

#include <cstdlib>
#include <system_error>
#include <tuple>

#include "dismantle/errors.h"
#include "dismantle/referenced_file.h"

namespace dismantle::ldraw {
namespace {

namespace fs = std::filesystem;

bool is_library(const fs::path& folder) {
  std::error_code ec;
  return fs::is_directory(folder / "parts", ec) || fs::is_directory(folder / "p", ec);
}

fs::path find_root(const fs::path& model, const fs::path& named) {
  if (!named.empty()) {
    if (!is_library(named))
      throw InputError(named.string(),
                       "importers.ldraw.library is no LDraw library: it has neither a folder 'parts' nor 'p'");
    return named;
  }
  if (const char* variable = std::getenv("LDRAWDIR"); variable != nullptr && is_library(variable)) return variable;
  const fs::path here = fs::absolute(model).parent_path();
  for (const fs::path& folder : {here, here.parent_path()})
    for (const char* name : {"library", "ldraw", "LDraw"})
      if (is_library(folder / name)) return folder / name;
  return {};
}

/// May a file of a model name this file: is it no path out of a folder?
bool is_inside(const std::string& key) {
  if (key.empty() || key.front() == '/' || key.find(':') != std::string::npos) return false;
  for (const fs::path& step : fs::path(key))
    if (step == "..") return false;
  return true;
}

}  // namespace

Library::Library(const fs::path& model, const fs::path& root)
    : model_(model), root_(find_root(model, root)), document_(parse(text_of(model), model)) {
  if (root_.empty()) return;
  // The first one counts: official parts before unofficial ones.
  for (const fs::path& folder : {root_, root_ / "unofficial", root_ / "UnOfficial"}) {
    index(folder / "parts", "", Origin::parts);
    index(folder / "p", "", Origin::primitives);
    index(folder / "models", "", Origin::folder);
  }
  read_colours();
}

void Library::index(const fs::path& folder, const std::string& prefix, Origin origin) {
  std::error_code ec;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ec)) {
    const std::string key = prefix + name_key(entry.path().filename().string());
    if (entry.is_directory(ec)) {
      if (prefix.empty()) index(entry.path(), key + "/", origin);
    } else if (entry.is_regular_file(ec)) {
      indexed_.emplace(key, std::pair(entry.path(), origin));
    }
  }
}

void Library::read_colours() {
  const fs::path file = root_ / "LDConfig.ldr";
  std::error_code ec;
  if (!fs::is_regular_file(file, ec)) return;
  for (const auto& [key, block] : parse(text_of(file), file).files)
    for (const Colour& colour : block.colours) colours_.emplace(colour.code, colour);
}

std::optional<Found> Library::find(const std::string& key) {
  if (const auto own = document_.files.find(key); own != document_.files.end())
    return Found{&own->second, Origin::document};
  if (const auto known = read_.find(key); known != read_.end()) {
    const Document& document = *known->second.first;
    return Found{&document.files.at(document.first), known->second.second};
  }
  if (!is_inside(key)) return std::nullopt;
  fs::path path;
  Origin origin = Origin::folder;
  const fs::path beside = model_.parent_path() / key;
  if (may_read_referenced(beside, model_)) {
    path = beside;
    own_files_.push_back(beside);
  } else if (const auto there = indexed_.find(key); there != indexed_.end()) {
    std::tie(path, origin) = there->second;
  } else {
    return std::nullopt;
  }
  auto document = std::make_unique<Document>(parse(text_of(path), path));
  const auto& kept = read_.emplace(key, std::pair(std::move(document), origin)).first->second.first;
  return Found{&kept->files.at(kept->first), origin};
}

std::string Library::why_missing(const std::string& key) const {
  if (!is_inside(key)) return fmt::format("'{}' leads out of the folder of the model, and is not read", key);
  if (root_.empty())
    return fmt::format(
        "'{}' is not in the file, and no LDraw library was found: set LDRAWDIR, or importers.ldraw.library", key);
  return fmt::format("'{}' is neither in the file nor in the library {}", key, root_.string());
}

const Colour* Library::colour(const std::string& code) {
  if (code.size() == 9 && code.starts_with("0x2"))
    return &colours_.try_emplace(code, Colour{code, "#" + code.substr(3)}).first->second;
  const auto known = colours_.find(code);
  return known == colours_.end() ? nullptr : &known->second;
}

}  // namespace dismantle::ldraw
