/// The columns of the table `trials` of a database of results. Each is described once; from these lists come the table,
/// what is written to it and read from it, the file by which a trial reports, Python's columns and the check of
/// docs/benchmark.md.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dismantle::bench {

// clang-format off
/// Known before the trial runs: COLUMN(type, name, doc).
#define DISMANTLE_TRIAL_PLAN(COLUMN) \
  COLUMN(std::string, assembly, "name of the assembly") \
  COLUMN(std::string, variant, "name of the variant") \
  COLUMN(std::string, planner, "name of the planner") \
  COLUMN(std::int64_t, seed, "seed of the trial") \
  COLUMN(std::string, category, "of the assembly") \
  COLUMN(std::string, part, "the part to take out; empty: the whole assembly is taken apart") \
  COLUMN(std::string, planner_hash, "SHA-256 of the planner's configuration without seed and folders; rows with another one are not reused") \
  COLUMN(std::string, config_hash, "SHA-256 of the complete configuration, `hash` in the table `configs`") \
  COLUMN(double, limit_path_timeout, "`limits.path_timeout`, s") \
  COLUMN(std::int64_t, limit_path_steps, "`limits.path_steps`") \
  COLUMN(double, limit_timeout, "`limits.timeout`, s; 0: none") \
  COLUMN(double, limit_wall, "s until the trial's processes are killed") \
  COLUMN(double, limit_cpu, "s of CPU time until the trial's process is killed") \
  COLUMN(std::int64_t, limit_memory_mb, "MiB of address space") \
  COLUMN(std::int64_t, threads, "`limits.threads`") \
  COLUMN(double, verify_max_penetration, "the verifier's tolerance, for an assembly of size 10")

/// What came of it. Optional: unknown if the trial ended earlier.
#define DISMANTLE_TRIAL_RESULT(COLUMN) \
  COLUMN(std::string, outcome, "see above") \
  COLUMN(bool, solved, "the planner says so, and the verifier accepts the plan") \
  COLUMN(std::optional<bool>, verified, "the verifier finds the plan valid") \
  COLUMN(std::optional<bool>, complete, "the verifier finds the plan complete") \
  COLUMN(std::optional<double>, max_penetration, "of the plan, by the verifier, for an assembly of size 10") \
  COLUMN(std::string, verification, "the verifier's objections, or why there is no verification") \
  COLUMN(std::int64_t, signal, "that ended the planning process; 0: none") \
  COLUMN(std::int64_t, exit_status, "of the planning process") \
  COLUMN(std::string, last_words, "the end of its standard error stream") \
  COLUMN(std::string, input, "path of the assembly") \
  COLUMN(std::string, input_sha256, "of its files") \
  COLUMN(std::optional<std::int64_t>, parts, "parts of the assembly") \
  COLUMN(std::optional<std::int64_t>, excluded, "parts that could not be used") \
  COLUMN(std::optional<std::int64_t>, removed, "parts that were removed") \
  COLUMN(std::optional<std::int64_t>, left_together, "parts that were not") \
  COLUMN(std::optional<std::int64_t>, steps, "steps of the plan") \
  COLUMN(std::optional<std::int64_t>, direction_changes, "changes of the direction of insertion between steps") \
  COLUMN(std::optional<std::int64_t>, off_axis, "steps along no coordinate axis") \
  COLUMN(std::optional<double>, path_length, "of the part that each step names first, in largest edges of the assembly") \
  COLUMN(std::optional<double>, path_turns, "whole turns of these parts") \
  COLUMN(std::string, checks, "cost of the plan by each step check of the objective, without weights, JSON") \
  COLUMN(double, wall_seconds, "of the planning process") \
  COLUMN(double, cpu_seconds, "of the planning process") \
  COLUMN(double, peak_rss_mb, "MiB, of the planning process") \
  COLUMN(std::optional<double>, load_seconds, "reading and preparing the input") \
  COLUMN(std::optional<double>, prepare_seconds, "preparing the simulator") \
  COLUMN(std::optional<double>, plan_seconds, "planning after that") \
  COLUMN(std::optional<double>, solve_seconds, "planning, with the preparation of the simulator") \
  COLUMN(std::optional<double>, proof_seconds, "of immobility provers, on all threads together; part of `solve_seconds`") \
  COLUMN(std::optional<double>, verify_seconds, "of the verifying process") \
  COLUMN(std::optional<std::int64_t>, attempts, "searches for a path") \
  COLUMN(std::optional<std::int64_t>, memoised, "questions that were answered from memory") \
  COLUMN(std::optional<double>, simulated_steps, "`counts.steps`; empty where a planner does not count it") \
  COLUMN(std::optional<double>, nodes, "`counts.nodes`") \
  COLUMN(std::optional<double>, collision_checks, "`counts.state_checks`") \
  COLUMN(std::string, counts, "all counts of the planner, JSON") \
  COLUMN(std::string, host, "name of the machine") \
  COLUMN(std::string, cpu_model, "of the machine") \
  COLUMN(std::string, version, "of Dismantle, and the commit that it was built from") \
  COLUMN(std::string, started, "UTC") \
  COLUMN(std::string, ended, "UTC")
// clang-format on

#define DISMANTLE_MEMBER(type, name, doc) type name{};
#define DISMANTLE_VISIT(type, name, doc) visit(#name, row.name, doc);

/// A trial before it runs. The first four columns are its unique key in a database.
struct TrialPlan {
  DISMANTLE_TRIAL_PLAN(DISMANTLE_MEMBER)
};

/// The results of a trial.
struct TrialResult {
  DISMANTLE_TRIAL_RESULT(DISMANTLE_MEMBER)
};

/// Calls visit(name, member, doc) for each column of a TrialPlan.
template <class Row, class Visit>
void for_plan_columns(Row&& row, Visit visit) {
  DISMANTLE_TRIAL_PLAN(DISMANTLE_VISIT)
}

/// Calls visit(name, member, doc) for each column of a TrialResult.
template <class Row, class Visit>
void for_result_columns(Row&& row, Visit visit) {
  DISMANTLE_TRIAL_RESULT(DISMANTLE_VISIT)
}

#undef DISMANTLE_MEMBER
#undef DISMANTLE_VISIT

/// A plugin of a planner. `section`: its place in the configuration.
struct PluginUse {
  std::string section, type, plugin, version, file, sha256;
};

/// A search for a path had a better state than before.
struct SearchPoint {
  std::int64_t search = 0;  ///< number in its trial
  double seconds = 0;       ///< of planning
  double effort = 0;        ///< SearchStats::cost
  double best = 0;          ///< way of the centre of a moving part, in largest edges of the assembly
  std::string part;         ///< the first part that moves
};

/// A node of a search tree.
struct SearchNode {
  std::int64_t search = 0, node = 0;
  std::int64_t parent = -1;  ///< -1: a root
  double effort = 0;
  std::array<double, 7> place{};  ///< centre of the first moving part, input units (3), and its rotation w, x, y, z
};

struct SearchRecords {
  std::vector<SearchPoint> points;  ///< in the order of time
  std::vector<SearchNode> nodes;    ///< parents before their children
};

/// A finished trial, as it is read from a database. Times in seconds.
struct ReportRow : TrialPlan, TrialResult {
  std::filesystem::path database;
  std::int64_t id = 0;  ///< of the row in `database`
  bool has_plan = false;
  double stops_at = 0;  ///< the time that stops the trial, as the report measures times: limits.timeout; 0: none
  /// Rows of one planner, variant and assembly have the same number if they are one observation: on the same input,
  /// solved by the same steps, or all not solved. Seeds of a planner that does not use them are no repetitions.
  std::size_t observation = 0;
  std::vector<std::pair<double, std::int64_t>> progress;  ///< seconds, parts removed
  std::vector<SearchPoint> searches;
};

/// Calls visit(name, member, doc) for each column of the table.
template <class Row, class Visit>
void for_columns(Row&& row, Visit visit) {
  for_plan_columns(row, visit);
  for_result_columns(row, visit);
}

}  // namespace dismantle::bench
