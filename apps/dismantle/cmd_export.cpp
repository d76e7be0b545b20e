// dismantle export PLAN.json --format FORMAT
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <sstream>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/animation.h"
#include "dismantle/plan_io/exports.h"
#include "dismantle/plan_io/job_list.h"
#include "dismantle/plan_io/robot_exports.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/process/child.h"
#include "frame_options.h"
#include "settings.h"
#include "stopped.h"
#ifdef DISMANTLE_BOOK_LIBRARY
#include "book_library.h"
#endif

namespace dismantle::app {
namespace {

std::string as_text(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

struct ExportFormat {
  const char *name, *file, *doc;
  bool binary;
  /// Null: the format needs the parts' surfaces.
  std::string (*of_plan)(const Plan&, const InputFrame&);
  /// Null: the plan suffices, or the format is a folder.
  std::string (*of_assembly)(const Plan&, const Assembly&, const InputFrame&);
  /// Not null: the format is a folder of several files, and `file` names it.
  std::vector<ExportedFile> (*of_folder)(const Plan&, const Assembly&, const InputFrame&) = nullptr;
  /// Not null: distances are better with the parts' surfaces, if they are there.
  std::string (*of_steps)(const Plan&, const InputFrame&, const GuidedDistances&) = nullptr;

  /// Drawn by the library of the book.
  bool is_film() const { return binary && of_assembly == nullptr; }
  /// Lengths are metres, whatever the input has.
  bool in_metres() const { return (binary && !is_film()) || of_folder != nullptr; }
};

constexpr std::array kExportFormats{
    ExportFormat{"poses-csv", "poses.csv", "poses with times, a row each", false, nullptr,
                 [](const Plan& p, const Assembly& a, const InputFrame&) { return poses_csv(p, a); }},
    ExportFormat{"poses-json", "poses.json", "the same as JSON", false, nullptr, poses_json},
    ExportFormat{"glb", "plan.glb", "the animation, binary glTF", true, nullptr,
                 [](const Plan& p, const Assembly& a, const InputFrame& f) { return as_text(to_glb(p, a, f)); }},
    ExportFormat{
        "glb-exploded", "exploded.glb", "the exploded assembly, binary glTF", true, nullptr,
        [](const Plan& p, const Assembly& a, const InputFrame& f) { return as_text(to_exploded_glb(p, a, f)); }},
    ExportFormat{"dot", "steps.dot", "which step waits for which, Graphviz", false,
                 [](const Plan& p, const InputFrame&) { return step_order_dot(p); }, nullptr},
    ExportFormat{"graphml", "steps.graphml", "the same as GraphML", false,
                 [](const Plan& p, const InputFrame&) { return step_order_graphml(p); }, nullptr},
    ExportFormat{"and-or-json", "and_or.json", "AND/OR graph of the sub-assemblies, JSON", false,
                 [](const Plan& p, const InputFrame&) { return and_or_json(p); }, nullptr},
    ExportFormat{"and-or-dot", "and_or.dot", "the same for Graphviz", false,
                 [](const Plan& p, const InputFrame&) { return and_or_dot(p); }, nullptr},
    ExportFormat{"bom-csv", "bom.csv", "bill of materials, a row each", false, nullptr, bom_csv},
    ExportFormat{"steps-csv", "steps.csv", "steps of the assembly, a row each", false, nullptr, nullptr, nullptr,
                 steps_csv},
    ExportFormat{"fasteners-csv", "fasteners.csv", "fasteners of the whole job, with their tools", false,
                 [](const Plan& p, const InputFrame&) { return fasteners_csv(p); }, nullptr},
    ExportFormat{"tools-csv", "tools.csv", "tools of the whole job", false,
                 [](const Plan& p, const InputFrame&) { return tools_csv(p); }, nullptr},
    ExportFormat{"markdown", "steps.md", "table of the steps", false, nullptr, nullptr, nullptr, steps_markdown},
    ExportFormat{"gif", "assembly.gif", "a film of the steps, animated GIF", true, nullptr, nullptr},
    ExportFormat{"mp4", "assembly.mp4", "the same as MP4, by the program ffmpeg", true, nullptr, nullptr},
    ExportFormat{"mjcf", "mjcf/", "a model for MuJoCo with a state for each step", false, nullptr, nullptr, to_mjcf},
    ExportFormat{"ros", "ros/", "a URDF and trajectories for ROS 2", false, nullptr, nullptr, to_ros},
};

struct ExportOptions {
  std::string plan, format, output, assembly;
  FrameOptions frame;
  bool disassembly = false;
  ConsoleOptions console;
};

int write_text(const std::string& content, const std::filesystem::path& file, bool to_stdout, Console& console) {
  console.end_progress();
  if (to_stdout) {
    fmt::print("{}", content);
    return kComplete;
  }
  write_file(file, content);
  console.text(fmt::format("wrote {}\n", file.string()));
  return kComplete;
}

int write_folder(const std::vector<ExportedFile>& files, const std::filesystem::path& folder, Console& console) {
  console.end_progress();
  std::string names;
  for (const ExportedFile& file : files) {
    const std::filesystem::path path = folder / file.name;
    open_output_folder(path.parent_path());
    write_file(path, file.content);
    if (file.name.find('/') == std::string::npos) names += " " + file.name;
  }
  console.text(fmt::format("wrote to {}:{}, and the meshes\n", folder.string(), names));
  return kComplete;
}

Assembly assembly_for(const Plan& plan, const ExportOptions& options, Console& console) {
  const Session session = reader(console);
  RunContext context = context_of(session, console);
  return stoppable(context,
                   [&] { return session.assembly_of(plan, source_of(plan, options.plan, options.assembly), context); });
}

/// Empty, with a warning, if the input is not there; one that the user names has to be.
GuidedDistances distances_of(const Plan& plan, const ExportOptions& options, Console& console) {
  if (!options.assembly.empty()) return guided_distances(plan, assembly_for(plan, options, console));
  try {
    return guided_distances(plan, assembly_for(plan, options, console));
  } catch (const InputError& e) {
    console.warning(
        fmt::format("distances are the lengths of the verified paths, because the input cannot be used: {}", e.what()));
    return {};
  }
}

#ifdef DISMANTLE_BOOK_LIBRARY
std::string film_of(const Plan& plan, const ExportOptions& options, const InputFrame& frame, const Session& session,
                    RunContext& context) {
  return stoppable(context, [&] {
    const Assembly assembly = session.assembly_of(plan, source_of(plan, options.plan, options.assembly), context);
    FilmOptions how;
    how.frame = frame;
    how.disassembly = options.disassembly;
    how.on_step = [&](std::size_t step, std::size_t steps) {
      if (context.should_stop()) throw Error("stopped");
      context.progress("drawing", step, steps, fmt::format("step {}", step));
    };
    return book_library().gif(plan, assembly, how);
  });
}
#else
std::string film_of(const Plan&, const ExportOptions&, const InputFrame&, const Session&, RunContext&) {
  throw Error("this program was built without pictures; install libpango1.0-dev and build again");
}
#endif

/// Path of a program that stands in $PATH, or nothing.
std::string program_named(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const std::string file = folder + "/" + name; !folder.empty() && ::access(file.c_str(), X_OK) == 0) return file;
  return {};
}

/// Has ffmpeg make a film of the GIF. @throws Error when it fails.
void write_mp4(const std::string& ffmpeg, const std::string& gif, const std::filesystem::path& file,
               const RunContext& context) {
  const std::filesystem::path source = file.string() + ".gif", target = file.string() + ".part.mp4";
  write_file(source, gif);
  const process::End end =
      process::run({.command = {ffmpeg, "-nostdin", "-loglevel", "error", "-y", "-i", source.string(), "-pix_fmt",
                                "yuv420p", "-movflags", "+faststart", target.string()}},
                   [&] { return context.should_stop(); });
  std::filesystem::remove(source);
  if (end.status != 0 || end.signal != 0) {
    std::filesystem::remove(target);
    throw Error(fmt::format("ffmpeg failed: {}", end.last_words));
  }
  std::filesystem::rename(target, file);
}

int export_film(const Plan& plan, const ExportOptions& options, const InputFrame& frame,
                const std::filesystem::path& target, Console& console) {
  const Session session = reader(console);
  RunContext context = context_of(session, console);
  const std::string ffmpeg = program_named("ffmpeg");
  if (options.format == "mp4" && ffmpeg.empty())
    throw Error(
        "--format mp4 needs the program ffmpeg, which is not there (Debian: apt-get install ffmpeg); gif does not");
  const std::string gif = film_of(plan, options, frame, session, context);
  if (options.format == "gif") return write_text(gif, target, false, console);
  console.end_progress();
  stoppable(context, [&] { write_mp4(ffmpeg, gif, target, context); });
  console.text(fmt::format("wrote {}\n", target.string()));
  return kComplete;
}

int export_plan(const ExportOptions& options) {
  Console console(options.console);
  const ExportFormat* format = nullptr;
  for (const ExportFormat& f : kExportFormats)
    if (options.format == f.name) format = &f;
  const Plan plan = read_plan(options.plan);
  const InputFrame frame = frame_of(plan, options.frame);
  const bool to_stdout = options.output == "-";
  if (to_stdout && format->binary) throw Error(fmt::format("{} is binary: name a file with -o", options.format));
  if (options.disassembly && !format->is_film()) throw Error("--disassembly is for films: gif, mp4");
  if (to_stdout && format->of_folder != nullptr)
    throw Error(fmt::format("{} is a folder of several files: name a folder with -o", options.format));
  const std::filesystem::path target = options.output.empty()
                                           ? std::filesystem::path(options.plan).replace_filename(format->file)
                                           : std::filesystem::path(options.output);

  if (format->of_plan != nullptr) return write_text(format->of_plan(plan, frame), target, to_stdout, console);
  if (format->of_steps != nullptr)
    return write_text(format->of_steps(plan, frame, distances_of(plan, options, console)), target, to_stdout, console);
  if (format->is_film()) return export_film(plan, options, frame, target, console);
  const Assembly assembly = assembly_for(plan, options, console);
  if (format->in_metres() && !frame.unit_known)
    console.warning(fmt::format("the files do not name their unit: {} is assumed; --unit names another", frame.unit));
  if (format->of_folder == nullptr)
    return write_text(format->of_assembly(plan, assembly, frame), target, to_stdout, console);
  return write_folder(format->of_folder(plan, assembly, frame), target, console);
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("export", "Write a plan for other programs: poses, graphs, glTF, Markdown, MuJoCo, ROS");
  auto options = std::make_shared<ExportOptions>();
  std::vector<std::string> names;
  std::string table = "Formats, and the file or folder that is written beside the plan:\n";
  for (const ExportFormat& f : kExportFormats) {
    names.emplace_back(f.name);
    table += fmt::format("  {:13} {:14} {}\n", f.name, f.file, f.doc);
  }
  command->add_option("PLAN.json", options->plan, "Plan file")->required()->option_text(" ");
  command->add_option("--format", options->format, "What to write, see below")
      ->required()
      ->option_text("FORMAT")
      ->check(CLI::IsMember(names));
  command->add_option("-o,--output", options->output, "The file or folder to write; '-' is standard output")
      ->option_text("FILE");
  command->add_option("--assembly", options->assembly, "The input that the plan is for, if it has moved")
      ->option_text("INPUT");
  command->add_flag("--disassembly", options->disassembly, "Films: how to take it apart, instead of together");
  add_frame(*command, options->frame);
  add_verbosity(*command, options->console);
  command->footer(
      table +
      "Poses, glTF, the bill of materials and folders need the input of the plan, the steps use it if it is there;\n"
      "all else is made from the plan alone.\n"
      "Examples:\n"
      "  dismantle export out/plan.json --format poses-csv\n"
      "  dismantle export out/plan.json --format and-or-dot -o - | dot -Tsvg > and_or.svg");
  command->callback([&action, options] { action = [options] { return export_plan(*options); }; });
}

}  // namespace dismantle::app
