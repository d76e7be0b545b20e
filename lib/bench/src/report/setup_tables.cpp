#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "report/cells.h"
#include "report/more_tables.h"

namespace dismantle::bench {
namespace {

/// The distinct values of the rows, in order.
template <class F>
std::string all_of(const ReportData& data, const F& value) {
  std::set<std::string> values;
  for (const auto& row : data.rows) values.insert(value(row));
  return fmt::format("{}", fmt::join(values, "; "));
}

std::string limits_of(const ReportRow& r) {
  std::string out = r.limit_path_timeout > 0 ? fmt::format("{:g} s for a path, ", r.limit_path_timeout) : "";
  if (r.limit_path_steps > 0) out += fmt::format("{} steps for a path, ", r.limit_path_steps);
  if (r.limit_timeout > 0) out += fmt::format("{:g} s of planning, ", r.limit_timeout);
  return out + fmt::format("{:g} s of wall-clock time, {:g} s of CPU time, {} MiB, {} thread{}", r.limit_wall,
                           r.limit_cpu, r.limit_memory_mb, r.threads, r.threads == 1 ? "" : "s");
}

/// "1..3, 7".
std::string ranges_of(const std::set<std::int64_t>& seeds) {
  std::string out;
  for (auto at = seeds.begin(); at != seeds.end();) {
    const std::int64_t first = *at;
    std::int64_t last = first;
    for (++at; at != seeds.end() && *at == last + 1; ++at) last = *at;
    out += (out.empty() ? "" : ", ") + (first == last ? fmt::format("{}", first) : fmt::format("{}..{}", first, last));
  }
  return out;
}

/// "1..3", or which planners have which seeds.
std::string seeds_of(const ReportData& data) {
  std::map<std::string, std::set<std::int64_t>> seeds;
  for (const auto& row : data.rows) seeds[row.planner].insert(row.seed);
  std::map<std::set<std::int64_t>, std::vector<std::string>> planners;
  for (const auto& planner : data.planners)
    if (const auto found = seeds.find(planner); found != seeds.end()) planners[found->second].push_back(planner);
  std::string out;
  for (const auto& [of, names] : planners)
    out += fmt::format("{}{}{}", out.empty() ? "" : "; ", ranges_of(of),
                       planners.size() > 1 ? fmt::format(" of {}", fmt::join(names, ", ")) : "");
  return out;
}

}  // namespace

Table setup_table(const ReportData& data) {
  Table table;
  table.id = "setup";
  table.title = "Machine, versions and limits";
  table.note = "Of the rows of this report; several values are separated by semicolons.";
  table.columns = {"what", "value"};
  if (data.rows.empty()) return table;
  std::string first = data.rows.front().started, last;
  for (const auto& row : data.rows) {
    first = std::min(first, row.started);
    last = std::max(last, row.ended);
  }
  const auto add = [&](const char* what, const std::string& value) { table.rows.push_back({text(what), text(value)}); };
  add("machine", all_of(data, [](const ReportRow& r) { return r.host + ", " + r.cpu_model; }));
  add("Dismantle", all_of(data, [](const ReportRow& r) { return r.version; }));
  add("date", first + " to " + last);
  add("limits", all_of(data, limits_of));
  add("tolerance of the verifier", all_of(data, [](const ReportRow& r) {
                                     return fmt::format("{:g}", r.verify_max_penetration);
                                   }) + ", for an assembly of size 10");
  add("seeds", seeds_of(data));
  return table;
}

Table planners_table(const ReportData& data) {
  Table table;
  table.id = "planners";
  table.title = "What the planners consist of";
  table.note =
      "Types by section of the configuration; plugins with version and the beginning of the SHA-256 of their files. "
      "'configuration': the beginning of `planner_hash`. `--row` writes the whole configuration.";
  table.columns = {"planner", "consists of", "plugins", "configuration"};
  for (const auto& planner : data.planners) {
    const auto uses = data.composition.find(planner);
    if (uses == data.composition.end()) continue;  // it has no row
    std::string types;
    std::set<std::string> plugins;
    for (const auto& use : uses->second) {
      types += fmt::format("{}{}: {}", types.empty() ? "" : ", ", use.section, use.type);
      plugins.insert(fmt::format("{} {} ({})", use.plugin, use.version, use.sha256.substr(0, 8)));
    }
    const auto row =
        std::find_if(data.rows.begin(), data.rows.end(), [&](const auto& r) { return r.planner == planner; });
    table.rows.push_back({text(planner), text(types), text(fmt::format("{}", fmt::join(plugins, ", "))),
                          text(row == data.rows.end() ? "" : row->planner_hash.substr(0, 8))});
  }
  return table;
}

}  // namespace dismantle::bench
