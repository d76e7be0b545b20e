#include "selection.h"

#include <algorithm>
#include <fstream>
#include <memory>
#include <sstream>

#include "dismantle/errors.h"

namespace dismantle::contract {
namespace {

struct State {
  Registry registry;
  std::set<std::string> chosen;  // empty: all
  std::set<std::string> expectations;
  bool expects = false;
  std::filesystem::path examples;
};

State& state() {
  static State all;
  return all;
}

bool has_required(const RegisteredType& t) {
  return std::any_of(t.type.params.begin(), t.type.params.end(), [](const ParamSpec& p) { return p.required; });
}

}  // namespace

void select(const Selection& selection) {
  State& s = state();
  s.registry.scan();
  for (const auto& file : selection.files)
    for (const auto& id : s.registry.load(file).types) s.chosen.insert(id);
  for (const auto& id : selection.ids) {
    s.registry.find(id);
    s.chosen.insert(id);
  }
  if (!selection.examples.empty() && !std::filesystem::is_directory(selection.examples))
    throw Error(selection.examples.string() + " is no folder");
  s.examples = selection.examples;
  if (selection.expectations.empty()) return;
  std::ifstream stream(selection.expectations);
  if (!stream) throw Error(selection.expectations.string() + " cannot be read");
  s.expects = true;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string joined;
    for (std::string word; words >> word;) joined += (joined.empty() ? "" : " ") + word;
    if (!joined.empty()) s.expectations.insert(joined);
  }
}

const Registry& registry() { return state().registry; }

std::vector<std::string> ids(PluginKind kind) {
  const State& s = state();
  std::vector<std::string> found;
  for (const RegisteredType* t : s.registry.types(kind))
    if ((s.chosen.empty() || s.chosen.contains(t->type.id)) && !has_required(*t)) found.push_back(t->type.id);
  return found;
}

std::vector<std::string> without_defaults() {
  const State& s = state();
  std::vector<std::string> found;
  for (const PluginKind kind : kPluginKinds)
    for (const RegisteredType* t : s.registry.types(kind))
      if ((s.chosen.empty() || s.chosen.contains(t->type.id)) && has_required(*t)) found.push_back(t->type.id);
  return found;
}

std::vector<std::filesystem::path> examples(const std::vector<std::string>& endings) {
  std::vector<std::filesystem::path> files;
  if (state().examples.empty()) return files;
  for (const auto& entry : std::filesystem::directory_iterator(state().examples)) {
    const std::string ending = entry.path().extension().string();
    if (entry.is_regular_file() && !ending.empty() &&
        std::find(endings.begin(), endings.end(), ending.substr(1)) != endings.end())
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool expected(const std::string& what, const std::string& id) { return state().expectations.contains(what + " " + id); }

std::vector<std::string> unexpected_skips(const std::set<std::string>& skipped) {
  std::vector<std::string> differences;
  const State& s = state();
  if (!s.expects) return differences;
  std::set<std::string> tested;
  for (const PluginKind kind : kPluginKinds)
    for (const auto& id : ids(kind)) tested.insert(id);
  for (const auto& id : without_defaults())
    if (!s.expectations.contains("has_no_defaults " + id))
      differences.push_back("cannot be made without parameters, and is not expected to be so: " + id);
  for (const auto& skip : skipped)
    if (!s.expectations.contains("skips " + skip)) differences.push_back("skipped, and not expected to be: " + skip);
  for (const auto& line : s.expectations) {
    if (!line.starts_with("skips ")) continue;
    const std::string skip = line.substr(6);
    if (tested.contains(skip.substr(0, skip.find(' '))) && !skipped.contains(skip))
      differences.push_back("expected to be skipped, and was not: " + skip);
  }
  return differences;
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '.' || c == '-'; }, '_');
  return name;
}

}  // namespace dismantle::contract
