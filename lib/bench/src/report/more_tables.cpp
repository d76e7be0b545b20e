#include "report/more_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "report/cells.h"
#include "report/named_figures.h"

namespace dismantle::bench {

Table precision_table(const std::vector<Contender>& contenders) {
  Table table;
  table.id = "precision";
  table.title = "Precision of the plans";
  table.note =
      "Deepest penetration of a plan's parts beyond their overlap when assembled, certified by the verifier over the "
      "whole motion; of an assembly scaled to size 10. Solved trials; the tolerance of the verifier is the suite's.";
  table.columns = {"planner", "plans", "smallest", "median", "largest"};
  for (const auto& c : contenders) {
    std::vector<double> depths;
    for (const ReportRow* row : c.rows)
      if (row->solved && row->max_penetration) depths.push_back(*row->max_penetration);
    std::sort(depths.begin(), depths.end());
    std::vector<TableCell> out = {text(c.label), whole(depths.size())};
    if (depths.empty())
      out.insert(out.end(), 3, text("-"));
    else
      for (const std::size_t at : {std::size_t{0}, (depths.size() - 1) / 2, depths.size() - 1})
        out.push_back(number(depths[at], "{:.2g}"));
    table.rows.push_back(std::move(out));
  }
  return table;
}

Table outcomes_table(const std::vector<Contender>& contenders) {
  Table table;
  table.id = "outcomes";
  table.title = "How trials ended";
  table.note =
      "'solved' here is what the planner says; 'refused' are plans that the verifier does not accept, whatever the "
      "planner says, and "
      "'not verified' plans that could not be verified.";
  std::set<std::string> names;
  for (const auto& c : contenders)
    for (const ReportRow* row : c.rows) names.insert(row->outcome);
  table.columns = {"planner", "trials"};
  table.columns.insert(table.columns.end(), names.begin(), names.end());
  table.columns.insert(table.columns.end(), {"refused", "not verified"});
  for (const auto& c : contenders) {
    std::map<std::string, std::size_t> counts;
    std::size_t refused = 0, unverified = 0;
    for (const ReportRow* row : c.rows) {
      ++counts[row->outcome];
      refused += row->verified == false ? 1 : 0;
      unverified += !row->verified && !row->verification.empty() ? 1 : 0;
    }
    std::vector<TableCell> out = {text(c.label), whole(c.rows.size())};
    for (const auto& name : names) out.push_back(whole(counts[name]));
    out.push_back(whole(refused));
    out.push_back(whole(unverified));
    table.rows.push_back(std::move(out));
  }
  return table;
}

Table trials_table(const ReportData& data, const std::vector<std::string>& links) {
  Table table;
  table.id = "trials";
  table.title = "Trials";
  table.note = "`dismantle report DIR --row N -o FOLDER` writes the plan and the configuration of row N.";
  const auto maybe = [](const auto& value) { return value ? number(double(*value), "{:.6g}") : text(""); };
  const auto yes_no = [](bool value) { return text(value ? "yes" : "no"); };
  std::set<std::string> named;  // columns that plugins have named
  for (const auto& r : data.rows)
    for (const auto& [name, value] : named_figures(r)) named.insert(name);
  std::size_t n = 0;
  for (const auto& r : data.rows) {
    std::string words = !r.verification.empty() && r.verified != true ? r.verification : r.last_words;
    while (!words.empty() && words.back() == '\n') words.pop_back();
    words = words.substr(words.rfind('\n') + 1);
    std::vector<std::pair<std::string, TableCell>> cells = {
        {"row", whole(++n)},
        {"assembly", text(r.assembly)},
        {"category", text(r.category)},
        {"parts", maybe(r.parts)},
        {"planner", text(r.planner)},
        {"variant", text(r.variant)},
        {"seed", number(double(r.seed), "{:.0f}")},
        {"outcome", text(r.outcome)},
        {"solved", yes_no(r.solved)},
        {"verified", r.verified ? yes_no(*r.verified) : text("")},
        {"deepest", maybe(r.max_penetration)},
        {"removed", maybe(r.removed)},
        {"steps", maybe(r.steps)},
        {"direction changes", maybe(r.direction_changes)},
        {"off axis", maybe(r.off_axis)},
        {"path length", maybe(r.path_length)},
        {"turns", maybe(r.path_turns)},
        {"seconds", maybe(r.solve_seconds)},
        {"wall s", number(r.wall_seconds, "{:.3f}")},
        {"cpu s", number(r.cpu_seconds, "{:.3f}")},
        {"verify s", maybe(r.verify_seconds)},
        {"proof s", maybe(r.proof_seconds)},
        {"peak MiB", number(r.peak_rss_mb, "{:.1f}")},
        {"signal", r.signal != 0 ? number(double(r.signal), "{:.0f}") : text("")},
        {"last words", text(words)}};
    const std::map<std::string, double> figures = named_figures(r);
    for (const std::string& name : named) {
      const auto found = figures.find(name);
      cells.emplace_back(name, found == figures.end() ? text("") : number(found->second, "{:.6g}"));
    }
    table.columns.clear();
    table.rows.emplace_back();
    for (const auto& [heading, cell] : cells) {
      table.columns.push_back(heading);
      table.rows.back().push_back(cell);
    }
    if (!links.empty()) table.rows.back().front().link = links.at(n - 1);
  }
  return table;
}

}  // namespace dismantle::bench
