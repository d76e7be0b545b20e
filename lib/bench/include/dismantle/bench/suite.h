/// Suite files: planners, assemblies, repetitions and limits. Format: docs/benchmark.md.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/host/config.h"
#include "dismantle/parameters.h"

namespace dismantle::bench {

/// The `limits:` section. It applies to every planner of a suite, so that they can be compared.
struct Limits {
  double path_timeout = 120;    ///< seconds per attempt, 0 = none
  std::int64_t path_steps = 0;  ///< simulated steps per attempt, 0 = none
  double timeout = 600;         ///< seconds of planning per trial, 0 = none
  double wall = 0;              ///< seconds until the trial's processes are killed; 0 = timeout + 60
  double cpu = 0;               ///< CPU seconds of the trial's process; 0 = threads * wall
  std::int64_t memory = 4096;   ///< MiB of address space of the trial's process
  unsigned threads = 1;
  static void describe(Schema<Limits>& s);
  double wall_limit() const { return wall > 0 ? wall : timeout + 60; }
  double cpu_limit() const { return cpu > 0 ? cpu : wall_limit() * threads; }
};

struct SuiteAssembly {
  std::string name;            ///< unique in the suite
  std::string category;        ///< column of the table of success rates
  std::string part;            ///< plan only this part; empty: the whole assembly
  std::filesystem::path path;  ///< absolute; empty for a sample
  std::string sample;
  ParamSet sample_values;
};

struct SuitePlanner {
  std::string name;
  RunConfig config;                    ///< with the suite's limits; the seed is set per trial
  std::shared_ptr<Registry> registry;  ///< for this planner only
  std::vector<std::int64_t> seeds;     ///< its own, or those of the suite
};

struct SuiteVariant {
  std::string name;
  bool rotate = false;                ///< turn the whole assembly by a random rotation drawn from the trial's seed
  std::string part;                   ///< plan only this part; overrides SuiteAssembly::part
  std::vector<std::string> planners;  ///< empty: all
};

/// A table of the suite's own in the reports: the mean of some figures for each planner.
struct SuiteTable {
  std::string id, title, note;
  std::vector<std::string> columns;  ///< numeric columns of the trials, counts.NAME or checks.NAME
  bool all_trials = false;           ///< false: only of trials on assemblies that all planners solved
};

struct Suite {
  std::filesystem::path file;
  std::string name, text;
  std::vector<SuiteAssembly> assemblies;
  std::vector<SuitePlanner> planners;
  std::vector<SuiteVariant> variants;
  std::vector<std::int64_t> seeds;  ///< of planners without seeds of their own
  Limits limits;
  double max_penetration =
      kDefaultTolerance;    ///< assembly units; the verifier's tolerance, overrides planners' configurations
  double verify_cpu = 600;  ///< CPU seconds of the verifying process; it is killed after twice that of wall-clock time
  std::vector<SuiteTable> tables;
  std::int64_t search_nodes = 0;   ///< nodes of search trees that each trial keeps
  std::vector<std::string> notes;  ///< optional entries that were skipped, and why
};

/// Reads a suite and everything that it names. @throws ConfigError with all problems found.
DISMANTLE_API Suite read_suite(const std::filesystem::path& file);

/// One cell of the matrix; indices into the suite.
struct Cell {
  std::size_t assembly = 0, variant = 0, planner = 0;
  std::int64_t seed = 1;
};
/// All cells, ordered by assembly, so that an unfinished campaign already compares all planners.
DISMANTLE_API std::vector<Cell> matrix(const Suite& suite);
/// Every count-th cell, beginning with `index` (from 1).
DISMANTLE_API std::vector<Cell> shard_of(const std::vector<Cell>& cells, unsigned index, unsigned count);

}  // namespace dismantle::bench
