// dismantle prepare INPUT -o DIR
#include <fmt/format.h>

#include <filesystem>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/preparation/write_prepared.h"
#include "report_text.h"
#include "settings.h"
#include "stopped.h"

namespace dismantle::app {
namespace {

struct Prepare {
  std::string input, folder;
  ConfigFlags config;
  ConsoleOptions console;
};

int prepare(const Prepare& options) {
  Console console(options.console);
  const Session session(options.config.source());
  warn_of_problems(session, console);
  // The output meshes would be parts of the next run, or replace the input.
  if (std::error_code error; std::filesystem::equivalent(options.input, options.folder, error))
    throw Error(fmt::format("{}: is the input itself: name another folder with -o", options.folder));
  open_output_folder(options.folder);
  RunContext context = context_of(session, console);
  const LoadedAssembly loaded = stoppable(context, [&] { return session.load(options.input, context); });
  const Assembly& assembly = *loaded.assembly;
  const auto files = write_prepared(assembly, loaded.report, options.folder);
  console.end_progress();
  console.text(prepare_text(assembly, loaded.report, options.console.verbose) +
               fmt::format("wrote {} files to {}\n", files.size(), options.folder));
  std::vector<std::string> unusable;
  for (const ExcludedPart& part : assembly.excluded)
    if (!part.by_choice) unusable.push_back(part.name);
  console.result({{"status", unusable.empty() ? "complete" : "partial"},
                  {"reason", unusable.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json("unusable")},
                  {"parts", assembly.parts.size()},
                  {"excluded", assembly.excluded.size()},
                  {"unusable", unusable},
                  {"report", files.back().string()}});
  return unusable.empty() ? kComplete : kPartial;
}

}  // namespace

void add_prepare(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("prepare", "Clean an assembly's meshes and say what was done to each part");
  auto options = std::make_shared<Prepare>();
  command->add_option("INPUT", options->input, "Folder of mesh files, or one file with several parts")
      ->required()
      ->option_text(" ");
  command->add_option("-o,--output", options->folder, "Where the cleaned meshes and prepare.json go")
      ->required()
      ->option_text("DIR");
  options->config.add_file_and_set(*command);
  options->config.add_key(*command, "--threads", "run.threads", "N", "Threads, 0 = all cores");
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer("Example:\n  dismantle prepare gearbox/ -o clean --set assembly.max_overlap=0.1");
  command->callback([&action, options] { action = [options] { return prepare(*options); }; });
}

}  // namespace dismantle::app
