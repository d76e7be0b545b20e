// dismantle book PLAN.json -o FILE.html|FILE.pdf
#include <fmt/format.h>

#include "dismantle/command.h"
#include "dismantle/console.h"
#include "dismantle/errors.h"
#include "dismantle/frame_options.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/settings.h"
#include "dismantle/stopped.h"
#ifdef DISMANTLE_BOOK_LIBRARY
#include "dismantle/book_library.h"
#endif

namespace dismantle::app {
namespace {

struct BookCommand {
  std::string plan, output, assembly, title;
  FrameOptions frame;
  bool disassembly = false;
  ConsoleOptions console;
};

#ifdef DISMANTLE_BOOK_LIBRARY
bool ends_with(const std::string& text, std::string_view ending) { return std::string_view(text).ends_with(ending); }

int write_book(const BookCommand& options) {
  Console console(options.console);
  const std::string output = options.output.empty()
                                 ? std::filesystem::path(options.plan).replace_filename("book.html").string()
                                 : options.output;
  const bool pdf = ends_with(output, ".pdf");
  if (!pdf && !ends_with(output, ".html") && !ends_with(output, ".htm"))
    throw Error(output + ": the ending says what is written: .html or .pdf");
  const BookLibrary& library = book_library();
  const Session session = reader(console);
  RunContext context = context_of(session, console);
  BookOptions how;
  const Plan plan = read_plan(options.plan);
  how.frame = frame_of(plan, options.frame);
  std::size_t pages = 0;
  const std::string book = stoppable(context, [&] {
    const Assembly assembly = session.assembly_of(plan, source_of(plan, options.plan, options.assembly), context);
    how.disassembly = options.disassembly;
    how.title = options.title;
    how.on_page = [&](std::size_t page, std::size_t count) {
      if (context.should_stop()) throw Error("stopped");
      context.progress("drawing", page, count, fmt::format("step {}", page));
      pages = count;
    };
    return (pdf ? library.pdf : library.html)(plan, assembly, how);
  });
  write_file(output, book);
  console.end_progress();
  console.text(fmt::format("wrote {}: {} steps\n", output, pages));
  console.result(
      {{"status", result_word(plan)}, {"steps", pages}, {"book", output}, {"plan", options.plan}});
  return kComplete;
}
#else
int write_book(const BookCommand&) {
  throw Error(
      "this program was built without instructions; install libpango1.0-dev and build again (docs/instructions.md)");
}
#endif

}  // namespace

void add_book(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("book", "Write instructions to print: parts list, a page per step");
  auto options = std::make_shared<BookCommand>();
  command->add_option("PLAN.json", options->plan, "Plan file")->required()->option_text(" ");
  command->add_option("-o,--output", options->output, "The file to write; default: book.html beside the plan")
      ->option_text("FILE.html|FILE.pdf");
  command->add_flag("--disassembly", options->disassembly, "How to take it apart, instead of how to put it together");
  command->add_option("--title", options->title, "Title; default: the name of the input")->option_text("TEXT");
  command->add_option("--assembly", options->assembly, "The input that the plan is for, if it has moved")
      ->option_text("INPUT");
  add_frame(*command, options->frame);
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "Example:\n"
      "  dismantle book out/plan.json -o gearbox.pdf --title 'Gearbox' --unit mm");
  command->callback([&action, options] { action = [options] { return write_book(*options); }; });
}

}  // namespace dismantle::app
