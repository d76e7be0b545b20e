#include "report/more_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace dismantle::bench {
namespace {

TableCell number(double value, const char* format = "{:.3g}") {
  return {fmt::format(fmt::runtime(format), value), value};
}
TableCell whole(std::size_t value) { return {std::to_string(value), double(value)}; }
TableCell text(const std::string& value) { return {value, std::nullopt}; }

std::vector<TableCell> pair_row(const Contender& a, const Contender& b) {
  std::map<std::pair<std::string, std::int64_t>, const ReportRow*> others;
  for (const ReportRow* row : b.rows) others[{row->assembly, row->seed}] = row;
  std::size_t both = 0, only_a = 0, only_b = 0, neither = 0, faster = 0;
  double seconds_a = 0, seconds_b = 0, log_ratio = 0;
  for (const ReportRow* row : a.rows) {
    const auto found = others.find({row->assembly, row->seed});
    if (found == others.end()) continue;
    const ReportRow* other = found->second;
    if (!row->solved || !other->solved) {
      ++(row->solved ? only_a : other->solved ? only_b : neither);
      continue;
    }
    ++both;
    // Zero has no logarithm; a microsecond is below the resolution of the measurement.
    const double ta = std::max(1e-6, time_of(*row)), tb = std::max(1e-6, time_of(*other));
    seconds_a += ta;
    seconds_b += tb;
    log_ratio += std::log(tb / ta);
    faster += ta < tb ? 1 : 0;
  }
  std::vector<TableCell> out = {text(a.label), text(b.label), whole(both),
                                whole(only_a), whole(only_b), whole(neither)};
  if (both == 0) {
    out.insert(out.end(), 4, text("-"));
    return out;
  }
  out.push_back(number(seconds_a / double(both)));
  out.push_back(number(seconds_b / double(both)));
  out.push_back(number(std::exp(log_ratio / double(both))));
  out.push_back(whole(faster));
  return out;
}

/// 1, 2, 5, 10, ... up to the longest time.
std::vector<double> round_times(double end) {
  std::vector<double> out;
  for (double power = 0.1; power < 1e7; power *= 10)
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double t = power * digit;
      if (t > end) return out;
      out.push_back(t);
    }
  return out;
}

/// True if a limit of the trial stopped it, so that it might have been solved later. A trial whose attempts all ended
/// before that limit (also by limits.path_timeout) would not have continued.
bool out_of_time(const ReportRow& row) {
  if (row.outcome == "wall_limit" || row.outcome == "cpu_limit") return true;
  return row.outcome == "timeout" && row.limit_timeout > 0 && time_of(row) >= row.limit_timeout;
}

}  // namespace

Table pairs_table(const std::vector<Contender>& contenders) {
  Table table;
  table.id = "pairs";
  table.title = "Two planners on the same trials";
  table.note =
      "Trials (assembly and seed) that both were given. Times are means over those that both solved, in seconds; the "
      "ratio is the "
      "geometric mean of B's time to A's: above 1, A is faster.";
  table.columns = {"A", "B", "both", "only A", "only B", "neither", "time A", "time B", "ratio B/A", "A faster"};
  for (std::size_t i = 0; i < contenders.size(); ++i)
    for (std::size_t k = i + 1; k < contenders.size(); ++k)
      if (contenders[i].variant == contenders[k].variant) table.rows.push_back(pair_row(contenders[i], contenders[k]));
  return table;
}

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

std::vector<Curve> curves_of(const ReportData& data) {
  std::vector<Curve> out;
  for (const auto& c : contenders_of(data)) {
    Curve curve;
    curve.label = c.label;
    std::vector<std::pair<double, bool>> events;
    std::size_t never = 0;
    for (const ReportRow* row : c.rows) {
      // Planners stop slightly after the limit. Trials that are solved or fail in that interval count at the limit, so
      // that they do not come after the trials that were stopped.
      const double time = row->limit_timeout > 0 ? std::min(time_of(*row), row->limit_timeout) : time_of(*row);
      curve.end = std::max(curve.end, time);
      if (row->solved || out_of_time(*row))
        events.emplace_back(time, row->solved);
      else
        ++never;
    }
    curve.steps = success_over_time(std::move(events), never);
    out.push_back(std::move(curve));
  }
  return out;
}

Table curves_table(const ReportData& data) {
  const auto curves = curves_of(data);
  double end = 0;
  for (const auto& curve : curves) end = std::max(end, curve.end);
  Table table;
  table.id = "curves";
  table.title = "Solved within a time (%)";
  table.note =
      "Seconds of planning. A trial that its time limit ended is censored there (1 - Kaplan-Meier); one that gave up, "
      "or "
      "whose attempts ran out of time before, counts as never solved. '-': nothing was observed for so long.";
  table.columns = {"planner"};
  const auto times = round_times(end);
  for (const double t : times) table.columns.push_back(fmt::format("{:g} s", t));
  for (const auto& curve : curves) {
    std::vector<TableCell> row = {text(curve.label)};
    for (const double t : times) {
      double share = 0;
      for (const auto& [at, value] : curve.steps)
        if (at <= t) share = value;
      row.push_back(t > curve.end ? text("-") : number(100 * share, "{:.1f}"));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table trials_table(const ReportData& data, const std::string& plans) {
  Table table;
  table.id = "trials";
  table.title = "Trials";
  table.note = "`dismantle report DIR --row N -o FOLDER` writes the plan and the configuration of row N.";
  const auto maybe = [](const auto& value) { return value ? number(double(*value), "{:.6g}") : text(""); };
  const auto yes_no = [](bool value) { return text(value ? "yes" : "no"); };
  std::size_t n = 0;
  for (const auto& r : data.rows) {
    std::string words = !r.verification.empty() && r.verified != true ? r.verification : r.last_words;
    while (!words.empty() && words.back() == '\n') words.pop_back();
    words = words.substr(words.rfind('\n') + 1);
    const std::vector<std::pair<const char*, TableCell>> cells = {
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
        {"seconds", maybe(r.solve_seconds)},
        {"wall s", number(r.wall_seconds, "{:.3f}")},
        {"cpu s", number(r.cpu_seconds, "{:.3f}")},
        {"verify s", maybe(r.verify_seconds)},
        {"proof s", maybe(r.proof_seconds)},
        {"peak MiB", number(r.peak_rss_mb, "{:.1f}")},
        {"signal", r.signal != 0 ? number(double(r.signal), "{:.0f}") : text("")},
        {"last words", text(words)}};
    table.columns.clear();
    table.rows.emplace_back();
    for (const auto& [heading, cell] : cells) {
      table.columns.push_back(heading);
      table.rows.back().push_back(cell);
    }
    if (!plans.empty() && r.has_plan) table.rows.back().front().link = fmt::format("{}/{}.json", plans, n);
  }
  return table;
}

}  // namespace dismantle::bench
