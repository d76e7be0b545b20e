// Main program of dismantle. Turns errors into messages and exit statuses.
#include <fcntl.h>
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "colour.h"
#include "command.h"
#include "console.h"
#include "crash_handler.h"
#include "dismantle/errors.h"
#include "dismantle/host/suggest.h"
#include "stopped.h"

namespace dismantle::app {
namespace {

/// True if the user asked for JSON; works also for a command line that cannot be parsed.
bool asks_for_json(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view arg = argv[i];
    if (arg == "--format=json" || (arg == "--format" && i + 1 < argc && std::string_view(argv[i + 1]) == "json"))
      return true;
  }
  return false;
}

int report_failure(bool json, int status, const std::string& message) {
  fmt::print(stderr, "dismantle: {} {}\n", coloured(stderr, Colour::red, "error:"), message);
  if (json)
    fmt::print("{}", result_line({{"status", status == kInterrupted ? "interrupted" : "error"}, {"message", message}}));
  return status;
}

/// Prints one per line without a prefix, since editors recognize `file:line:column: error: message`.
int report_diagnostics(bool json, const ConfigError& e) {
  std::string all;
  for (const auto& d : e.diagnostics()) all += (all.empty() ? "" : "\n") + d.text();
  fmt::print(stderr, "{}\n", all);
  if (json) fmt::print("{}", result_line({{"status", "error"}, {"message", all}}));
  return kUsage;
}

/// The sub-commands that the help shows.
std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!command->get_group().empty()) names.push_back(command->get_name());
  return names;
}

/// Reports an unknown command or sub-command; empty if there is none. The parser would only call it missing.
std::string unknown_command(const CLI::App& app, int argc, char** argv) {
  const CLI::App* at = &app;
  for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
    const auto commands = at->get_subcommands([](const CLI::App*) { return true; });
    if (commands.empty()) break;
    const std::vector<std::string> names = commands_of(*at);  // hidden commands are internal
    const CLI::App* next = nullptr;
    for (const CLI::App* command : commands)
      if (command->get_name() == argv[i]) next = command;
    if (next == nullptr) {
      const auto near = nearest(argv[i], names);
      return fmt::format("{} has no command '{}'{}; its commands are {}", at->get_name(), argv[i],
                         near ? fmt::format(", did you mean '{}'", *near) : "", fmt::join(names, ", "));
    }
    at = next;
  }
  return "";
}

/// Describes the problem with the arguments and what to do next.
std::string usage_problem(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const CLI::App* at = &app;
  std::string path = app.get_name();
  for (int i = 1; i < argc; ++i) {
    const auto below = at->get_subcommands([&](const CLI::App* c) { return c->get_name() == argv[i]; });
    if (below.empty()) break;
    at = below.front();
    path += " " + at->get_name();
  }
  std::string what = error.what();
  const auto commands = commands_of(*at);
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && !commands.empty())
    what = fmt::format("a command is missing; the commands of '{}' are {}", path, fmt::join(commands, ", "));
  else if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && what.ends_with(" missing"))
    what = fmt::format("{} needs a value", what.substr(0, what.find(':')));
  return fmt::format("{}\nTry '{} --help'.", what, path);
}

int run(CLI::App& app, Action& action, int argc, char** argv) {
  const bool json = asks_for_json(argc, argv);
  if (const auto problem = unknown_command(app, argc, argv); !problem.empty())
    return report_failure(json, kUsage, problem);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {  // --help and --version
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    return report_failure(json, kUsage, usage_problem(app, e, argc, argv));
  }
  if (!app.got_subcommand("bench") && !app.got_subcommand("bench-trial")) {  // bench reports the end of its processes
    static RunNotes notes;
    report_crashes(nullptr, notes, AfterCrash::exit, json);
  }
  try {
    return action();
  } catch (const ConfigError& e) {
    return report_diagnostics(json, e);
  } catch (const InputError& e) {
    return report_failure(json, kBadInput, e.what());
  } catch (const PluginError& e) {
    return report_failure(json, kPluginFailed, e.what());
  } catch (const Stopped& e) {
    return report_failure(json, e.status(), e.what());
  } catch (const Error& e) {
    return report_failure(json, kUsage, e.what());
  } catch (const std::filesystem::filesystem_error& e) {
    return report_failure(json, kUsage, fmt::format("{}: {}", e.path1().string(), e.code().message()));
  } catch (const std::bad_alloc&) {
    return report_failure(json, kBadInput, "not enough memory for this input");
  } catch (const std::exception& e) {
    return report_failure(json, kPluginFailed, fmt::format("internal error: {}", e.what()));
  }
}

/// If the caller has closed a standard stream, the next opened file would get its descriptor and messages would be
/// written to that file. Opens /dev/null in its place.
void open_standard_streams() {
  for (int fd = 0; fd <= 2; ++fd)
    if (::fcntl(fd, F_GETFD) == -1 && ::open("/dev/null", O_RDWR) != fd) return;
}

/// The first line is the program's version; the build generates the list DISMANTLE_BUILT_WITH.
std::string version_text() {
  std::string out = "dismantle " DISMANTLE_VERSION "\nbuilt with";
  std::istringstream libraries(DISMANTLE_BUILT_WITH);
  bool first = true;
  for (std::string library; std::getline(libraries, library, ','); first = false) out += (first ? " " : ", ") + library;
  return out;
}

/// Turns success into an error if standard output could not be written.
int flushed(int status) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  fmt::print(stderr, "dismantle: error: standard output cannot be written\n");
  return status == kComplete || status == kPartial ? kUsage : status;
}

}  // namespace
}  // namespace dismantle::app

int main(int argc, char** argv) {
  using namespace dismantle::app;
  open_standard_streams();
  CLI::App app("Takes assemblies apart, to find out how to put them together.", "dismantle");
  app.set_version_flag("--version", version_text(), "Print the version, and those of the libraries it was built with");
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  dismantle sample peg_in_hole -o peg && dismantle plan peg\n"
      "  dismantle plan gearbox/ -c configs/paper.yaml -o out\n"
      "  dismantle verify out/plan.json\n"
      "  dismantle bench configs/bench/smoke.yaml -o smoke && dismantle report smoke\n"
      "Exit status: 0 complete, 1 not all parts came out or some could not be used, 2 usage or configuration, 3 "
      "unusable input,\n"
      "4 a plugin failed, 130 interrupted.");
  Action action;
  add_plan(app, action);
  add_check(app, action);
  add_stability(app, action);
  add_prepare(app, action);
  add_verify(app, action);
  add_explain(app, action);
  add_access(app, action);
  add_replay(app, action);
  add_compare(app, action);
  add_diff(app, action);
  add_edit(app, action);
#ifdef DISMANTLE_SERVE
  add_serve(app, action);
#endif
  add_view(app, action);
  add_export(app, action);
  add_book(app, action);
  add_plugins(app, action);
  add_sample(app, action);
  add_bench(app, action);
  add_report(app, action);
  add_completion(app, action);
  return flushed(run(app, action, argc, argv));
}
