// dismantle book PLAN.json -o FILE.html|FILE.pdf
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/host/config_node.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/write_file.h"
#include "frame_options.h"
#include "settings.h"
#include "stopped.h"
#ifdef DISMANTLE_BOOK_LIBRARY
#include "book_library.h"
#endif

namespace dismantle::app {
namespace {

struct BookCommand {
  std::string plan, output, assembly, title, revision, notes, language;
  FrameOptions frame;
  bool disassembly = false;
  ConsoleOptions console;
};

#ifdef DISMANTLE_BOOK_LIBRARY
/// The tree of a file that is a map with these keys at most. @throws ConfigError.
ConfigNode read_book_map(const std::string& file, const std::vector<std::string>& keys) {
  std::vector<Diagnostic> problems;
  ConfigNode root;
  std::string unreadable;
  if (!read_yaml(file, root, problems, unreadable)) throw Error(unreadable);
  if (!root.is_map() && problems.empty()) problems.push_back(root.mark.error("a map of keys is expected"));
  for (const ConfigMember& member : root.members)
    if (std::ranges::find(keys, member.key) == keys.end())
      problems.push_back(
          member.key_mark.error(fmt::format("unknown key '{}'; there are: {}", member.key, fmt::join(keys, ", "))));
  if (!problems.empty()) throw ConfigError(std::move(problems));
  return root;
}

[[noreturn]] void fail_at(const ConfigMark& mark, const std::string& message) {
  throw ConfigError({mark.error(message)});
}

const std::string& scalar_text(const ConfigNode& node, const char* what) {
  if (!node.is_scalar()) fail_at(node.mark, fmt::format("{} is a text, not {}", what, node.kind_name()));
  return node.scalar;
}

/// The sets of parts that steps move, each sorted.
std::vector<std::vector<std::string>> moved_part_sets(const Plan& plan) {
  std::vector<std::vector<std::string>> out;
  for (const PlanStep& step : plan.disassembly) {
    out.emplace_back();
    for (const PlanMove& move : step.moves) out.back().push_back(move.part);
    std::ranges::sort(out.back());
  }
  return out;
}

/// `notes: [{parts: [NAME...], text: TEXT}...]`, as the page saves them. @throws ConfigError with file:line:column,
/// also for a note on parts that no step of the plan moves together.
std::vector<BookNote> read_notes(const std::string& file, const Plan& plan) {
  const ConfigNode root = read_book_map(file, {"notes"});
  const ConfigMember* list = root.find("notes");
  if (list == nullptr || list->value.kind != ConfigNode::Kind::sequence)
    fail_at(list == nullptr ? root.mark : list->value.mark, "'notes' is a list of {parts: [...], text: ...}");
  const auto moved = moved_part_sets(plan);
  std::vector<BookNote> out;
  for (const ConfigNode& item : list->value.items) {
    const ConfigMember *parts = item.find("parts"), *text = item.find("text");
    if (parts == nullptr || text == nullptr || item.members.size() != 2 ||
        parts->value.kind != ConfigNode::Kind::sequence)
      fail_at(item.mark, "a note is {parts: [...], text: ...}");
    BookNote note{{}, scalar_text(text->value, "the text of a note")};
    for (const ConfigNode& name : parts->value.items) note.parts.push_back(scalar_text(name, "the name of a part"));
    std::vector<std::string> sorted = note.parts;
    std::ranges::sort(sorted);
    if (std::ranges::find(moved, sorted) == moved.end())
      fail_at(item.mark, fmt::format("no step of the plan moves just these parts: {}", fmt::join(note.parts, ", ")));
    out.push_back(std::move(note));
  }
  return out;
}

/// `language: de` and `phrases: {ENGLISH: TRANSLATION...}`, into `options`. @throws ConfigError with file:line:column.
void read_words(const std::string& file, BookOptions& options) {
  const ConfigNode root = read_book_map(file, {"language", "phrases"});
  const ConfigMember *language = root.find("language"), *phrases = root.find("phrases");
  if (language == nullptr || phrases == nullptr || !phrases->value.is_map())
    fail_at(root.mark, "a language file has 'language', as in HTML (de, fr), and 'phrases', a map from English texts");
  options.language = scalar_text(language->value, "the language");
  for (const ConfigMember& member : phrases->value.members) {
    const std::string& other = scalar_text(member.value, "a translation");
    if (!same_places(member.key, other))
      fail_at(member.value.mark, fmt::format("the translation of '{}' needs as many places {{}} as it", member.key));
    options.phrases.emplace(member.key, other);
  }
}

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
  how.revision = options.revision;
  if (!options.notes.empty()) how.notes = read_notes(options.notes, plan);
  if (!options.language.empty()) read_words(options.language, how);
  std::size_t pages = 0;
  const std::string book = stoppable(context, [&] {
    const Assembly assembly = session.assembly_of(plan, source_of(plan, options.plan, options.assembly), context);
    how.disassembly = options.disassembly;
    how.title = options.title;
    how.on_page = [&](std::size_t page, std::size_t count) {
      if (context.should_stop()) throw Error("stopped");
      context.progress("drawing", page, count, fmt::format("page {}", page));
      pages = count;
    };
    return (pdf ? library.pdf : library.html)(plan, assembly, how);
  });
  write_file(output, book);
  console.end_progress();
  const std::size_t steps = plan.disassembly.size();
  console.text(
      fmt::format("wrote {}: {} steps{}\n", output, steps, pages < steps ? fmt::format(" on {} pages", pages) : ""));
  console.result({{"status", result_word(plan)},
                  {"steps", steps},
                  {"step_pages", pages},
                  {"book", output},
                  {"plan", options.plan}});
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
  command->add_option("--revision", options->revision, "Revision of the instructions, on the title and each page")
      ->option_text("TEXT");
  command->add_option("--notes", options->notes, "Your notes on steps, as the page saves them (notes.yaml)")
      ->option_text("FILE.yaml");
  command->add_option("--language", options->language, "Language file, see docs/instructions.md; default: English")
      ->option_text("FILE.yaml");
  command->add_option("--assembly", options->assembly, "The input that the plan is for, if it has moved")
      ->option_text("INPUT");
  add_frame(*command, options->frame);
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "Examples:\n"
      "  dismantle book out/plan.json --revision B --language configs/languages/de.yaml\n"
      "  dismantle book out/plan.json -o gearbox.pdf --title 'Gearbox' --unit mm");
  command->callback([&action, options] { action = [options] { return write_book(*options); }; });
}

}  // namespace dismantle::app
