// dismantle report DIR...
#include <fmt/format.h>

#include <algorithm>

#include "command.h"
#include "console.h"
#include "dismantle/bench/report.h"
#include "dismantle/errors.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/write_file.h"
#include "settings.h"

namespace dismantle::app {
namespace {

struct ReportOptions {
  std::vector<std::string> inputs, tables;
  std::string format = "text", time = "wall", output, arena;
  std::size_t row = 0;
  bool plans = false, pages = false;
};

/// The requested tables. Default: all; without the list of trials as text, only that list as CSV.
std::vector<bench::Table> chosen(std::vector<bench::Table> all, const ReportOptions& options) {
  std::vector<bench::Table> out;
  std::vector<std::string> ids;
  for (const auto& table : all) ids.push_back(table.id);
  for (const auto& name : options.tables)
    if (std::find(ids.begin(), ids.end(), name) == ids.end())
      throw Error(fmt::format("--table {}: there is no such table; there are {}", name, fmt::join(ids, ", ")));
  for (auto& table : all) {
    const bool named = std::find(options.tables.begin(), options.tables.end(), table.id) != options.tables.end();
    const bool usual = options.format == "csv"    ? table.id == "trials"
                       : options.format == "text" ? table.id != "trials"
                                                  : true;
    if (options.tables.empty() ? usual : named) out.push_back(std::move(table));
  }
  return out;
}

/// Writes a page beside each plan, and lets its link lead there. A plan whose input is gone keeps its link.
void write_pages(const std::filesystem::path& folder, std::vector<std::string>& links) {
  if (!has_viewer()) throw Error(kNoViewer);
  const Session session = Session::reader();
  for (std::string& link : links) {
    if (link.empty()) continue;
    try {
      const auto [plan, assembly] = session.load_plan(folder / link);
      const std::string page = std::filesystem::path(link).replace_extension(".html").string();
      write_file(folder / page, page_of(plan, assembly));
      link = page;
    } catch (const InputError& e) {
      fmt::print(stderr, "warning: {} has no page: {}\n", (folder / link).string(), e.what());
    }
  }
}

std::string rendered(const bench::ReportData& data, const ReportOptions& options) {
  std::vector<std::string> links;
  if (options.plans || options.pages) {
    if (options.format != "html" || options.output.empty())
      throw Error(fmt::format("{} needs --format html and -o FILE: the page links to plans in a folder beside it",
                              options.pages ? "--pages" : "--plans"));
    const std::filesystem::path folder = std::filesystem::path(options.output).replace_extension(".plans");
    open_output_folder(folder);
    links = bench::write_plans(data, folder);
    if (options.pages) write_pages(folder.parent_path(), links);
  }
  if (options.format == "svg") {
    if (!options.tables.empty())
      throw Error("--table and --format svg exclude each other: the picture is of the curves");
    return bench::report_svg(data);
  }
  const auto tables = chosen(bench::tables_of(data, links), options);
  if (options.format == "markdown") return bench::report_markdown(data, tables);
  if (options.format == "csv") return bench::report_csv(tables);
  if (options.format == "html") return bench::report_html(data, tables);
  return bench::report_text(data, tables);
}

int report(const ReportOptions& options) {
  bench::ReportData data = bench::read_results({options.inputs.begin(), options.inputs.end()});
  if (options.time == "cpu") bench::use_cpu_time(data);
  if (options.row > 0) {
    if (options.output.empty()) throw Error("--row needs -o FOLDER: where should the plan and the configuration go?");
    if (options.row > data.rows.size())
      throw Error(fmt::format("--row {}: there are {} rows", options.row, data.rows.size()));
    open_output_folder(options.output);
    fmt::print("wrote {}; to run it again:\n  {}\n", options.output,
               bench::write_row(data.rows[options.row - 1], options.output));
    return kComplete;
  }
  if (!options.arena.empty()) {
    bench::write_arena(data, options.arena);
    fmt::print(stderr, "wrote {}\n", options.arena);
    if (options.output.empty()) return kComplete;
  }
  const std::string text = rendered(data, options);
  if (options.output.empty())
    fmt::print("{}", text);
  else
    write_file(options.output, text);
  return kComplete;
}

}  // namespace

void add_report(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("report", "Tables and curves of what `bench` has run");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("DIR", options->inputs, "Folders with results, or databases; any number, merged")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--format", options->format,
                   "text, markdown, csv (the trials), svg (the curves), or html: one self-contained page")
      ->check(CLI::IsMember({"text", "markdown", "csv", "svg", "html"}))
      ->option_text("text|markdown|csv|svg|html");
  command
      ->add_option("--time", options->time,
                   "What times are: wall time of planning (default), or CPU time, for trials on a busy machine")
      ->check(CLI::IsMember({"wall", "cpu"}))
      ->option_text("wall|cpu");
  command->add_option("-o,--output", options->output, "File to write; with --row: folder")->option_text("FILE");
  command->add_option("--table", options->tables, "Just this table; may be repeated")
      ->option_text(
          "setup|planners|success|sizes|time|solution|plans|precision|pairs|outcomes|counts|progress|searches|curves|"
          "trials|ID")
      ->take_all()
      ->allow_extra_args(false);
  command->add_flag("--plans", options->plans, "html: write all plans beside the page, and link each row to its plan")
      ->option_text(" ");
  command
      ->add_flag("--pages", options->pages,
                 "html: as --plans, and a page for each plan, which its row opens; needs the inputs")
      ->option_text(" ");
  command->add_option("--arena", options->arena, "Write a database that OMPL's Planner Arena opens")
      ->option_text("FILE.db");
  command->add_option("--row", options->row, "Write plan and configuration of this row of the trials")
      ->check(CLI::PositiveNumber)
      ->option_text("N");
  command->footer(
      "Examples:\n"
      "  dismantle report smoke.bench\n"
      "  dismantle report cluster/ --format html -o report.html\n"
      "  dismantle report smoke.bench --format csv -o trials.csv\n"
      "  dismantle report smoke.bench --row 12 -o row12");
  command->callback([&action, options] { action = [options] { return report(*options); }; });
}

}  // namespace dismantle::app
