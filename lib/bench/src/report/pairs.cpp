#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "dismantle/bench/statistics.h"
#include "report/cells.h"
#include "report/more_tables.h"

namespace dismantle::bench {
namespace {

/// What two planners did on common trials that are one observation.
struct Common {
  bool a = false, b = false;                    // solved
  double seconds_a = 0, seconds_b = 0;          // sums
  bool censored_a = false, censored_b = false;  // by a limit: it might have been solved later
  double trials = 0;
  double time_a() const { return seconds_a / trials; }
  double time_b() const { return seconds_b / trials; }
};

std::vector<Common> common_observations(const Contender& a, const Contender& b) {
  std::map<std::pair<std::string, std::int64_t>, const ReportRow*> others;
  for (const ReportRow* row : b.rows) others[{row->assembly, row->seed}] = row;
  std::map<std::pair<std::size_t, std::size_t>, Common> out;
  for (const ReportRow* row : a.rows) {
    const auto found = others.find({row->assembly, row->seed});
    if (found == others.end()) continue;
    const ReportRow& other = *found->second;
    Common& c = out[{row->observation, other.observation}];
    c.a = row->solved;
    c.b = other.solved;
    // Zero has no logarithm; a microsecond is below the resolution of the measurement.
    c.seconds_a += std::max(1e-6, observed_time(*row));
    c.seconds_b += std::max(1e-6, observed_time(other));
    c.censored_a = c.censored_a || out_of_time(*row);
    c.censored_b = c.censored_b || out_of_time(other);
    ++c.trials;
  }
  std::vector<Common> list;
  for (const auto& entry : out) list.push_back(entry.second);
  return list;
}

/// True when A's solution came first. Unknown, so false, when B was stopped before it.
bool sooner(bool solved, double time, bool other_solved, double other_time, bool other_censored) {
  if (!solved) return false;
  if (other_solved) return time < other_time;
  return !other_censored || time <= other_time;
}

std::vector<TableCell> pair_row(const Contender& a, const Contender& b) {
  std::size_t both = 0, only_a = 0, only_b = 0, neither = 0, sooner_a = 0, sooner_b = 0;
  double seconds_a = 0, seconds_b = 0, sum = 0;
  std::vector<double> log_ratios;
  const std::vector<Common> observations = common_observations(a, b);
  for (const Common& c : observations) {
    ++(c.a && c.b ? both : c.a ? only_a : c.b ? only_b : neither);
    sooner_a += sooner(c.a, c.time_a(), c.b, c.time_b(), c.censored_b) ? 1 : 0;
    sooner_b += sooner(c.b, c.time_b(), c.a, c.time_a(), c.censored_a) ? 1 : 0;
    if (!c.a || !c.b) continue;
    seconds_a += c.time_a();
    seconds_b += c.time_b();
    log_ratios.push_back(std::log(c.time_b() / c.time_a()));
    sum += log_ratios.back();
  }
  std::vector<TableCell> out = {text(a.label),
                                text(b.label),
                                whole(observations.size()),
                                whole(both),
                                whole(only_a),
                                whole(only_b),
                                whole(neither),
                                number(sign_test(only_a, only_b), "{:.2g}"),
                                whole(sooner_a),
                                whole(sooner_b),
                                number(sign_test(sooner_a, sooner_b), "{:.2g}")};
  if (both == 0) {
    out.insert(out.end(), 5, text("-"));
    return out;
  }
  const SignedRanks ranks = wilcoxon(std::move(log_ratios));
  out.push_back(number(seconds_a / double(both)));
  out.push_back(number(seconds_b / double(both)));
  out.push_back(number(std::exp(sum / double(both))));
  out.push_back(number(ranks.p, "{:.2g}"));
  out.push_back(number(ranks.effect, "{:+.2f}"));
  return out;
}

}  // namespace

Table pairs_table(const std::vector<Contender>& contenders) {
  Table table;
  table.id = "pairs";
  table.title = "Two planners on the same trials";
  table.note =
      "n: observations that both were given: trials (assembly and seed), where seeds that changed nothing are one. "
      "'p solved': exact sign test (McNemar) of 'only A' against 'only B'. 'sooner': who had a solution first; a planner "
      "that a limit stopped before the other's solution is left out; 'p sooner': exact sign test. Times are means over "
      "observations that both solved, in seconds; the ratio is the geometric mean of B's time to A's: above 1, A is "
      "faster. 'p time': Wilcoxon's signed-rank test of the logarithms of these ratios; 'effect': their rank-biserial "
      "correlation, from +1 (A always faster) to -1 (B always faster). All tests are two-sided; they are not corrected "
      "for the number of pairs.";
  table.columns = {"A",        "B",        "n",        "both",   "only A", "only B",    "neither", "p solved",
                   "sooner A", "sooner B", "p sooner", "time A", "time B", "ratio B/A", "p time",  "effect"};
  for (std::size_t i = 0; i < contenders.size(); ++i)
    for (std::size_t k = i + 1; k < contenders.size(); ++k)
      if (contenders[i].variant == contenders[k].variant) table.rows.push_back(pair_row(contenders[i], contenders[k]));
  return table;
}

}  // namespace dismantle::bench
