#include "suite/assemblies.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "dismantle/host/config_bind.h"
#include "dismantle/host/suggest.h"
#include "dismantle/preparation/read_input.h"
#include "dismantle/samples/samples.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;

/// The keys of an entry whose values are scalars.
struct EntryValues {
  std::string glob, path, sample, name, category, part;
  bool optional = false;
  static void describe(Schema<EntryValues>& s) {
    s.add("glob", &EntryValues::glob, {.doc = "Shell pattern; each match is one assembly."});
    s.add("path", &EntryValues::path, {.doc = "One assembly: a folder of mesh files, or a file."});
    s.add("sample", &EntryValues::sample, {.doc = "One of the parametric samples."});
    s.add("name", &EntryValues::name, {.doc = "Name in the tables; only for an entry with one assembly."});
    s.add("category", &EntryValues::category, {.doc = "Column of the table of success rates."});
    s.add("part", &EntryValues::part, {.doc = "Plan only this part; all others are fixed."});
    s.add("optional", &EntryValues::optional, {.doc = "Skip the entry, with a note, if it does not exist."});
  }
};

/// Paths that match the pattern, in natural order. Patterns may have braces, {a,b}.
std::vector<fs::path> matches_of(const std::string& pattern) {
  glob_t found = {};
  std::vector<fs::path> out;
  if (::glob(pattern.c_str(), GLOB_BRACE | GLOB_NOSORT, nullptr, &found) == 0)
    for (std::size_t i = 0; i < found.gl_pathc; ++i) out.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  std::sort(out.begin(), out.end(),
            [](const fs::path& a, const fs::path& b) { return natural_less(a.string(), b.string()); });
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// "/data/two_part/peg_short/" -> "two_part/peg_short".
std::string name_of(fs::path path) {
  if (!path.has_filename()) path = path.parent_path();
  const std::string folder = path.parent_path().filename().string();
  return folder.empty() ? path.filename().string() : folder + "/" + path.filename().string();
}

class Entry {
 public:
  Entry(const ConfigNode& node, std::size_t number, Suite& suite, std::vector<Diagnostic>& problems)
      : node_(node), label_(fmt::format("assemblies[{}]", number)), suite_(suite), problems_(problems) {}

  void read() {
    if (!node_.is_map()) return fail(node_.mark, "must be a map of keys, not " + std::string(node_.kind_name()));
    ConfigNode plain = node_;
    for (const char* key : {"paths", "except", "set"}) plain.erase(key);
    const KeyHomes homes = {{"paths", {"assemblies"}}, {"except", {"assemblies"}}, {"set", {"assemblies"}}};
    std::map<std::string, std::string> origins;
    const std::size_t before = problems_.size();
    values_ = Schema<EntryValues>().bind(
        bind_section(Schema<EntryValues>().specs(), &plain, {label_, "", ""}, homes, origins, problems_));
    int kinds = 0;
    for (const char* key : {"glob", "path", "paths", "sample"}) kinds += has(key) ? 1 : 0;
    if (kinds != 1) return fail(node_.mark, "needs exactly one of glob, path, paths and sample");
    if (has("set") && !has("sample")) fail(mark_of("set"), "set is for samples only");
    if (has("except") && !has("glob")) fail(mark_of("except"), "except is for glob only");
    if (has("name") && !has("path") && !has("sample")) fail(mark_of("name"), "name is for one path or sample only");
    if (problems_.size() != before) return;
    if (has("sample")) return add_sample();
    if (has("glob")) return add_matches();
    if (has("path")) return add_path(values_.path, mark_of("path"));
    for (const auto& text : texts("paths")) add_path(text.scalar, text.mark);
  }

 private:
  bool has(const char* key) const { return node_.find(key) != nullptr; }
  const ConfigMark& mark_of(const char* key) const { return node_.find(key)->value.mark; }
  void fail(const ConfigMark& mark, const std::string& what) {
    problems_.push_back(mark.error(fmt::format("{} {}", label_, what)));
  }

  std::vector<ConfigNode> texts(const char* key) {
    const auto* member = node_.find(key);
    if (member == nullptr) return {};
    std::vector<ConfigNode> out;
    if (member->value.kind != ConfigNode::Kind::sequence) {
      fail(member->value.mark, fmt::format("{} must be a list of texts, not {}", key, member->value.kind_name()));
      return out;
    }
    for (const auto& item : member->value.items) {
      if (item.is_scalar() && !item.scalar.empty())
        out.push_back(item);
      else
        fail(item.mark, fmt::format("{} must hold texts, not {}", key, item.kind_name()));
    }
    return out;
  }

  /// Path after replacing variables; relative ones start at the suite's folder.
  std::optional<fs::path> located(std::string text, const ConfigMark& mark) {
    if (!expand_variables(text, suite_.file)) {
      if (!values_.optional)
        fail(mark, fmt::format("needs the environment variable {0}, which is not set; set it, as in {0}=FOLDER, or say "
                               "'optional: true'",
                               text));
      else
        suite_.notes.push_back(fmt::format("{}: left aside: {} is not set", mark.text(), text));
      return std::nullopt;
    }
    return fs::absolute(suite_.file).parent_path() / text;
  }

  void missing(const ConfigMark& mark, const std::string& what) {
    if (values_.optional)
      suite_.notes.push_back(fmt::format("{}: left aside: {}", mark.text(), what));
    else
      fail(mark, what + "; say 'optional: true' if the suite should do without");
  }

  void add(SuiteAssembly assembly, const ConfigMark& mark) {
    for (const auto& other : suite_.assemblies)
      if (other.name == assembly.name)
        return fail(mark, fmt::format("gives a second assembly of the name '{}'; names must differ", assembly.name));
    assembly.category = values_.category;
    assembly.part = values_.part;
    suite_.assemblies.push_back(std::move(assembly));
  }

  void add_path(const std::string& text, const ConfigMark& mark) {
    const auto path = located(text, mark);
    if (!path) return;
    std::error_code error;
    if (!fs::exists(*path, error)) return missing(mark, fmt::format("'{}' does not exist", path->string()));
    SuiteAssembly assembly;
    assembly.path = fs::canonical(*path);
    assembly.name = values_.name.empty() ? name_of(assembly.path) : values_.name;
    add(std::move(assembly), mark);
  }

  void add_matches() {
    const ConfigMark& mark = mark_of("glob");
    const auto pattern = located(values_.glob, mark);
    if (!pattern) return;
    const auto found = matches_of(pattern->string());
    if (found.empty()) return missing(mark, fmt::format("nothing matches '{}'", pattern->string()));
    std::map<std::string, std::pair<ConfigMark, bool>> except;
    for (const auto& text : texts("except")) except[text.scalar] = {text.mark, false};
    for (const auto& path : found) {
      SuiteAssembly assembly;
      assembly.path = fs::canonical(path);
      assembly.name = name_of(assembly.path);
      const auto left_out = except.find(assembly.path.filename().string());
      if (left_out == except.end())
        add(std::move(assembly), mark);
      else
        left_out->second.second = true;
    }
    for (const auto& [name, use] : except)
      if (!use.second) fail(use.first, fmt::format("except '{}' takes nothing away: no match has this name", name));
  }

  void add_sample() {
    const samples::Sample* sample = samples::find(values_.sample);
    if (sample == nullptr) {
      std::vector<std::string> names;
      for (const auto& s : samples::list()) names.push_back(s.name);
      const auto near = nearest(values_.sample, names);
      return fail(mark_of("sample"),
                  fmt::format("there is no sample '{}'{} (see 'dismantle sample list')", values_.sample,
                              near ? fmt::format("; did you mean '{}'?", *near) : ""));
    }
    SuiteAssembly assembly;
    assembly.sample = sample->name;
    const ConfigNode* set = has("set") ? &node_.find("set")->value : nullptr;
    std::map<std::string, std::string> origins;
    const std::size_t before = problems_.size();
    assembly.sample_values =
        bind_section(sample->params, set, {label_ + ".set", sample->name, ""}, {}, origins, problems_);
    if (problems_.size() != before) return;
    std::string values;
    if (set != nullptr)
      for (const auto& member : set->members)
        values += fmt::format("{}{}={}", values.empty() ? "" : ",", member.key,
                              to_text(assembly.sample_values.at(member.key)));
    assembly.name = !values_.name.empty() ? values_.name
                    : values.empty()      ? sample->name
                                          : sample->name + "(" + values + ")";
    try {
      samples::make(assembly.sample, assembly.sample_values);
    } catch (const std::invalid_argument& e) {  // inconsistent values
      return fail(mark_of("sample"), fmt::format("sample {}: {}", assembly.sample, e.what()));
    }
    add(std::move(assembly), mark_of("sample"));
  }

  const ConfigNode& node_;
  std::string label_;
  Suite& suite_;
  std::vector<Diagnostic>& problems_;
  EntryValues values_;
};

}  // namespace

void read_assemblies(const ConfigNode& list, Suite& suite, std::vector<Diagnostic>& problems) {
  if (list.kind != ConfigNode::Kind::sequence) {
    problems.push_back(list.mark.error(fmt::format("assemblies must be a list, not {}", list.kind_name())));
    return;
  }
  const std::size_t before = problems.size();
  for (std::size_t i = 0; i < list.items.size(); ++i) Entry(list.items[i], i + 1, suite, problems).read();
  if (suite.assemblies.empty() && problems.size() == before) {
    std::string notes;
    for (const auto& note : suite.notes) notes += "; " + note;
    problems.push_back(list.mark.error("the suite has no assembly" + notes));
  }
}

}  // namespace dismantle::bench
