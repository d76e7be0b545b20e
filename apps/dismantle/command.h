/// Sub-commands. Each add_... declares one with its options. Parsing stores the chosen sub-command in `action`.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace dismantle::app {

/// Exit statuses (docs/cli.md).
enum ExitStatus : int {
  kComplete = 0,
  kPartial = 1,
  kUsage = 2,
  kBadInput = 3,
  kPluginFailed = 4,
  kInterrupted = 130,
};

using Action = std::function<int()>;

void add_plan(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_stability(CLI::App& app, Action& action);
void add_prepare(CLI::App& app, Action& action);
void add_verify(CLI::App& app, Action& action);
void add_explain(CLI::App& app, Action& action);
void add_access(CLI::App& app, Action& action);
void add_replay(CLI::App& app, Action& action);
void add_diff(CLI::App& app, Action& action);
void add_edit(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
#ifdef DISMANTLE_SERVE  // without cpp-httplib there is no server
void add_serve(CLI::App& app, Action& action);
#endif
void add_view(CLI::App& app, Action& action);
void add_export(CLI::App& app, Action& action);
void add_book(CLI::App& app, Action& action);
void add_plugins(CLI::App& app, Action& action);
void add_sample(CLI::App& app, Action& action);
void add_bench(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);
void add_completion(CLI::App& app, Action& action);

}  // namespace dismantle::app
