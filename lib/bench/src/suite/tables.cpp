#include "suite/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

#include "dismantle/bench/trial_row.h"
#include "dismantle/host/config_bind.h"
#include "dismantle/host/suggest.h"

namespace dismantle::bench {
namespace {

enum class Trials { solved, all };

struct TableValues {
  std::string id, title, note;
  Trials trials = Trials::solved;
  static void describe(Schema<TableValues>& s) {
    s.add("id", &TableValues::id, {.doc = "Name for --table."});
    s.add("title", &TableValues::title, {.doc = "Heading; default: the id."});
    s.add("note", &TableValues::note, {.doc = "Text below the heading."});
    s.add_choice("trials", &TableValues::trials,
                 {{"solved", Trials::solved, "Solved trials of the assemblies that every planner solved."},
                  {"all", Trials::all, "All trials that have the figure."}},
                 "What the means are over.");
  }
};

/// Columns of trials that hold numbers.
std::vector<std::string> number_columns() {
  std::vector<std::string> out;
  for_result_columns(TrialResult{}, [&]<class T>(const char* name, const T&, const char*) {
    if constexpr (!std::is_same_v<T, std::string>) out.emplace_back(name);
  });
  return out;
}

bool is_figure(const std::string& name, const std::vector<std::string>& known) {
  const auto named = [&](std::string_view prefix) { return name.starts_with(prefix) && name.size() > prefix.size(); };
  return named("counts.") || named("checks.") || std::ranges::find(known, name) != known.end();
}

std::vector<std::string> read_columns(const ConfigNode& table, std::vector<Diagnostic>& problems) {
  const auto* member = table.find("columns");
  if (member == nullptr || member->value.kind != ConfigNode::Kind::sequence || member->value.items.empty()) {
    problems.push_back(
        (member == nullptr ? table.mark : member->value.mark)
            .error("a table needs columns: a list of columns of the trials, counts.NAME or checks.NAME"));
    return {};
  }
  const std::vector<std::string> known = number_columns();
  std::vector<std::string> out;
  for (const ConfigNode& item : member->value.items) {
    out.push_back(item.scalar);
    if (is_figure(item.scalar, known)) continue;
    const auto near = nearest(item.scalar, known);
    problems.push_back(
        item.mark.error(fmt::format("trials have no column '{}' with numbers{}; what planners count is counts.NAME, "
                                    "what step checks cost checks.NAME",
                                    item.scalar, near ? fmt::format("; did you mean '{}'?", *near) : "")));
  }
  return out;
}

}  // namespace

std::vector<SuiteTable> read_tables(const ConfigNode& list, std::vector<Diagnostic>& problems) {
  std::vector<SuiteTable> out;
  if (list.kind != ConfigNode::Kind::sequence)
    problems.push_back(
        list.mark.error("tables must be a list, such as [{id: work, columns: [attempts, counts.nodes]}]"));
  std::set<std::string> ids(kOwnTables.begin(), kOwnTables.end());
  for (const ConfigNode& item : list.items) {
    if (!item.is_map()) {
      problems.push_back(item.mark.error("a table must be a map with the keys id, columns, title, note and trials"));
      continue;
    }
    ConfigNode plain = item;
    plain.erase("columns");
    std::map<std::string, std::string> origins;
    const auto values = Schema<TableValues>().bind(bind_section(
        Schema<TableValues>().specs(), &plain, {"tables", "", ""}, {{"columns", {"a table"}}}, origins, problems));
    SuiteTable table{values.id, values.title.empty() ? values.id : values.title, values.note,
                     read_columns(item, problems), values.trials == Trials::all};
    const bool word = !table.id.empty() && std::ranges::all_of(table.id, [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
    });
    if (!word)
      problems.push_back(item.mark.error("a table needs an id of lower-case letters, digits, '_' and '.'"));
    else if (!ids.insert(table.id).second)
      problems.push_back(item.mark.error(fmt::format("there is already a table '{}'", table.id)));
    out.push_back(std::move(table));
  }
  return out;
}

}  // namespace dismantle::bench
