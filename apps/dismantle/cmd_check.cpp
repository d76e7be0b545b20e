// dismantle check INPUT
#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <utility>

#ifdef DISMANTLE_BOOK_LIBRARY
#include "book_library.h"
#endif
#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/preparation/check_assembly.h"
#include "dismantle/session/objective.h"
#include "settings.h"
#include "stopped.h"

namespace dismantle::app {
namespace {

struct Check {
  std::string input, pictures, gallery;
  ConfigFlags config;
  ConsoleOptions console;
};

#ifdef DISMANTLE_BOOK_LIBRARY
PartId part_named(const Assembly& assembly, const std::string& name) {
  for (const Part& part : assembly.parts)
    if (part.name == name) return part.id;
  throw std::logic_error("a finding names a part that the assembly does not have: " + name);
}

/// Draws one file for each pair with a known place: overlap_01.png, ...
void draw_pairs(AssemblyCheck& check, const Assembly& assembly, const Check& options, const Eigen::Vector3d& up,
                const RunContext& context) {
  const BookLibrary& library = book_library();
  const std::filesystem::path folder = options.pictures;
  std::filesystem::create_directories(folder);
  unsigned number = 0;
  for (Finding& finding : check.findings) {
    if (finding.parts.size() != 2 || !finding.at) continue;
    if (context.should_stop()) throw Error("stopped while drawing");
    PartId large = part_named(assembly, finding.parts[0]), small = part_named(assembly, finding.parts[1]);
    const auto size = [&](PartId id) { return assembly.parts[id].mesh->box().size().norm(); };
    if (size(large) < size(small)) std::swap(large, small);
    const std::filesystem::path file = folder / fmt::format("overlap_{:02}.png", ++number);
    write_file(file, library.pair_png(assembly, large, small, *finding.at, up));
    finding.picture = file.string();
  }
}

void write_gallery(const AssemblyCheck& check, const Assembly& assembly, const Check& options,
                   const Eigen::Vector3d& up, const RunContext& context) {
  const auto stop = [&] {
    if (context.should_stop()) throw Error("stopped while drawing");
  };
  std::vector<std::string> order;
  for (const CheckedKind& k : check.kinds) order.push_back(k.kind.kind);
  write_file(options.gallery, book_library().kinds_html(assembly, order, up, stop));
}
#else
void write_gallery(const AssemblyCheck&, const Assembly&, const Check&, const Eigen::Vector3d&, const RunContext&) {
  throw Error("this program was built without pictures; install libpango1.0-dev and build again");
}

void draw_pairs(AssemblyCheck&, const Assembly&, const Check&, const Eigen::Vector3d&, const RunContext&) {
  throw Error("this program was built without pictures; install libpango1.0-dev and build again");
}
#endif

/// What an exit status other than 0 is about.
nlohmann::ordered_json reason(const AssemblyCheck& check, bool usable) {
  if (!usable) return "unusable_input";
  if (!check.sound()) return "errors_found";
  return nullptr;
}

int finish(const AssemblyCheck& check, const Check& options, bool usable, Console& console) {
  console.end_progress();
  console.text(findings_text(check, options.input, options.console.verbose));
  if (options.console.quiet)
    for (const Finding& finding : check.findings)
      if (finding.severity == Severity::error) console.error(finding.message);
  nlohmann::ordered_json json = {{"status", usable ? "complete" : "error"}, {"reason", reason(check, usable)}};
  json.update(nlohmann::ordered_json::parse(findings_json(check)));
  console.result(std::move(json));
  if (!usable) return kBadInput;
  return check.sound() ? kComplete : kPartial;
}

int check(const Check& options) {
  Console console(options.console);
  const Session session(options.config.source());
  warn_of_problems(session, console);
  RunContext context = context_of(session, console);
  context.on_log = nullptr;  // the findings contain everything
  PrepareReport report;
  try {
    const LoadedAssembly loaded =
        stoppable(context, [&] { return session.load(options.input, context, {.report = &report}); });
    const Assembly& assembly = *loaded.assembly;
    AssemblyCheck found = stoppable(context, [&] {
      const double resolution =
          0.01 * session.config().verify.max_penetration;  // far below the tolerance of the verifier
      return check_assembly(assembly, report, resolution, context);
    });
    const Eigen::Vector3d up = up_of(session.config().layout, assembly);
    if (!options.gallery.empty()) write_gallery(found, assembly, options, up, context);
    if (!options.pictures.empty()) draw_pairs(found, assembly, options, up, context);
    return finish(found, options, true, console);
  } catch (const InputError&) {
    if (report.parts.empty()) throw;
    return finish(check_parts(report), options, false, console);
  }
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("check", "Find out what is wrong with an assembly before anyone plans");
  auto options = std::make_shared<Check>();
  command->add_option("INPUT", options->input, "Folder of mesh files (one part each), or one file with several parts")
      ->required()
      ->option_text(" ");
  command->add_option("--pictures", options->pictures, "Folder for a picture of each place where two parts overlap")
      ->option_text("DIR");
  command->add_option("--gallery", options->gallery, "HTML file with a picture of each kind of part, to correct kinds")
      ->option_text("FILE");
  options->config.add_file_and_set(*command);
  options->config.add_key(*command, "--unit", "assembly.unit", "UNIT", "Unit of an input that names none: mm, inch...");
  options->config.add_key(*command, "--threads", "run.threads", "N", "Threads, 0 = all cores");
  options->config.add_key(*command, "--up", "layout.up", "x|y|z|-x|-y|-z|X,Y,Z",
                          "What is up in the input's coordinates");
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "Finds parts that are open, have no volume or had to be repaired, duplicates, pairs that overlap (depth, place, "
      "class),\n"
      "parts inside the solid of others, and parts that touch nothing. Counts the contacts of each class.\n"
      "Says what plan says about the input, too. Exit status: 0 no errors, 1 errors, or parts are left\n"
      "out, 3 the input cannot be planned with. Warnings alone are no failure.\n"
      "Examples:\n"
      "  dismantle check gearbox/\n"
      "  dismantle check gearbox/ --pictures overlaps/\n"
      "  dismantle check gearbox/ --gallery kinds.html\n"
      "  dismantle check gearbox/ --format json -q | tail -n 1");
  command->callback([&action, options] { action = [options] { return check(*options); }; });
}

}  // namespace dismantle::app
