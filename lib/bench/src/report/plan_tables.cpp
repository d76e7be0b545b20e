// Tables of what the plans are like, and of what the planners count.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "report/cells.h"
#include "report/more_tables.h"
#include "report/named_figures.h"

namespace dismantle::bench {
namespace {

using Figures = std::map<std::string, double>;
using FiguresOf = std::function<Figures(const ReportRow&)>;

/// The figures of a plan, by the headings of the table.
Figures plan_figures(const ReportRow& row) {
  Figures out = named_figures(row.checks, "cost of ");
  const auto add = [&](const char* name, const auto& value) {
    if (value) out[name] = static_cast<double>(*value);
  };
  add("steps", row.steps);
  add("changes of direction", row.direction_changes);
  add("along no axis", row.off_axis);
  add("path length", row.path_length);
  add("turns", row.path_turns);
  add("deepest", row.max_penetration);
  return out;
}

struct TableOptions {
  bool all_trials = false;         // not only the solved ones of assemblies that all planners solved
  bool all_of_first = false;       // columns that no planner has are shown, too
  std::string counts = "counts.";  // how the names of what planners count begin
};

/// The mean of each figure: over the solved trials of an assembly, then over assemblies. A figure that a trial does not
/// have is not counted; but what a planner counts in one trial, and not in another, is 0 there.
Figures means_of(const Contender& c, const std::set<std::string>& assemblies, const FiguresOf& figures,
                 const TableOptions& options) {
  struct Mean {
    double sum = 0, count = 0;
  };
  std::set<std::string> counted;
  for (const ReportRow* row : c.rows)
    for (const auto& [name, value] : figures(*row))
      if (name.starts_with(options.counts)) counted.insert(name);
  std::map<std::string, std::map<std::string, Mean>> each;  // figure, assembly
  for (const ReportRow* row : c.rows) {
    if (!options.all_trials && !(row->solved && assemblies.contains(row->assembly))) continue;
    Figures own = figures(*row);
    if (!row->counts.empty())  // else it ended before it could count
      for (const std::string& name : counted) own.try_emplace(name, 0);
    for (const auto& [name, value] : own) {
      Mean& mean = each[name][row->assembly];
      mean.sum += value;
      ++mean.count;
    }
  }
  Figures out;
  for (const auto& [name, means] : each) {
    double sum = 0;
    for (const auto& [assembly, mean] : means) sum += mean.sum / mean.count;
    out[name] = sum / static_cast<double>(means.size());
  }
  return out;
}

std::set<std::string> solved_by(const Contender& c) {
  std::set<std::string> out;
  for (const ReportRow* row : c.rows)
    if (row->solved) out.insert(row->assembly);
  return out;
}

/// The assemblies that all planners of the variant solved, of those that solved any.
std::set<std::string> solved_by_all(const std::vector<Contender>& contenders, const Contender& c) {
  std::set<std::string> common = solved_by(c);
  for (const Contender& other : contenders) {
    const std::set<std::string> theirs = other.variant == c.variant ? solved_by(other) : std::set<std::string>();
    if (!theirs.empty()) std::erase_if(common, [&](const std::string& name) { return !theirs.contains(name); });
  }
  return common;
}

/// Names the columns that no trial has, misspelt ones perhaps, and what there is.
std::string missing_columns(const SuiteTable& wanted, const std::vector<Contender>& contenders) {
  std::set<std::string> known;
  for (const Contender& c : contenders)
    for (const ReportRow* row : c.rows)
      for (const auto& [name, value] : named_figures(*row)) known.insert(name);
  std::string out;
  for (const std::string& name : wanted.columns) {
    const std::string kind = name.substr(0, name.find('.') + 1);
    if ((kind != "counts." && kind != "checks.") || known.contains(name)) continue;
    std::vector<std::string> others;
    for (const std::string& other : known)
      if (other.starts_with(kind)) others.push_back(other);
    out += fmt::format("{}No trial has `{}`; there {}.", out.empty() ? "" : " ", name,
                       others.empty() ? "are none of this kind" : fmt::format("are {}", fmt::join(others, ", ")));
  }
  return out;
}

Table table_of(const std::vector<Contender>& contenders, const std::vector<std::string>& first,
               const FiguresOf& figures, const TableOptions& options = {}) {
  std::vector<Figures> means;
  std::set<std::string> names;
  std::vector<std::size_t> counts;
  for (const Contender& c : contenders) {
    const std::set<std::string> common = solved_by_all(contenders, c);
    std::set<std::string> all;
    for (const ReportRow* row : c.rows) all.insert(row->assembly);
    counts.push_back(options.all_trials ? all.size() : common.size());
    means.push_back(means_of(c, common, figures, options));
    for (const auto& [name, value] : means.back()) names.insert(name);
  }
  std::vector<std::string> order;
  for (const std::string& name : first)
    if (names.erase(name) > 0 || options.all_of_first) order.push_back(name);
  order.insert(order.end(), names.begin(), names.end());
  Table table;
  table.columns = {"planner", "assemblies"};
  table.columns.insert(table.columns.end(), order.begin(), order.end());
  for (std::size_t k = 0; k < contenders.size(); ++k) {
    std::vector<TableCell> row = {text(contenders[k].label), whole(counts[k])};
    for (const std::string& name : order) {
      const auto mean = means[k].find(name);
      row.push_back(mean == means[k].end() ? text("-") : number(mean->second, "{:.4g}"));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

std::map<std::string, double> named_figures(const std::string& json, const std::string& prefix) {
  std::map<std::string, double> out;
  const nlohmann::json figures = nlohmann::json::parse(json, nullptr, false);
  if (!figures.is_object()) return out;
  for (const auto& [name, value] : figures.items())
    if (value.is_number()) out[prefix + name] = value.get<double>();
  return out;
}

std::map<std::string, double> named_figures(const ReportRow& row) {
  std::map<std::string, double> figures = named_figures(row.checks, "checks.");
  figures.merge(named_figures(row.counts, "counts."));
  return figures;
}

Table plans_table(const std::vector<Contender>& contenders) {
  Table table = table_of(
      contenders, {"steps", "changes of direction", "along no axis", "path length", "turns", "deepest"}, plan_figures);
  table.id = "plans";
  table.title = "What the plans are like";
  table.note =
      "Over the assemblies that every planner solved, of those planners that solved any: the mean over an assembly's "
      "solved trials, then over assemblies. Directions are those of insertion; the path length, of the part that each "
      "step names first, is in largest edges of the assembly, turns are whole ones. Costs are those of the step checks "
      "of the suite's objective, without weights.";
  return table;
}

Table suite_table(const SuiteTable& wanted, const std::vector<Contender>& contenders) {
  const auto figures = [&](const ReportRow& row) {
    Figures known = named_figures(row);
    for_result_columns(row, [&]<class T>(const char* name, const T& value, const char*) {
      if constexpr (std::is_arithmetic_v<T>)
        known[name] = static_cast<double>(value);
      else if constexpr (!std::is_same_v<T, std::string>)
        if (value) known[name] = static_cast<double>(*value);
    });
    Figures out;
    for (const std::string& name : wanted.columns)
      if (const auto found = known.find(name); found != known.end()) out.insert(*found);
    return out;
  };
  Table table = table_of(contenders, wanted.columns, figures, {wanted.all_trials, true});
  table.id = wanted.id;
  table.title = wanted.title;
  table.note = wanted.note + (wanted.note.empty() ? "" : " ") +
               (wanted.all_trials
                    ? "The mean over an assembly's trials that have the figure, then over assemblies."
                    : "Over the assemblies that every planner solved, of those planners that solved any: the mean over "
                      "an assembly's solved trials, then over assemblies.");
  table.remark = missing_columns(wanted, contenders);
  return table;
}

Table counts_table(const std::vector<Contender>& contenders) {
  Table table =
      table_of(contenders, {}, [](const ReportRow& row) { return named_figures(row.counts, ""); }, {.counts = ""});
  table.id = "counts";
  table.title = "What the planners count";
  table.note =
      "The counts that planners report of themselves, under their own names; over the same trials as the table of "
      "plans.";
  return table;
}

}  // namespace dismantle::bench
