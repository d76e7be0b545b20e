// dismantle edit PLAN.json [--order LIST|ORDER.csv] [--move-step N --before N|--after N] [--direction N=DIR]... -o DIR
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/orders/order.h"
#include "dismantle/plan_io/order_words.h"
#include "dismantle/plan_io/step_numbers.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/session/edit.h"
#include "dismantle/session/session.h"
#include "plan_files.h"
#include "plan_report.h"
#include "settings.h"
#include "stopped.h"

namespace dismantle::app {
namespace {

namespace fs = std::filesystem;

struct EditOptions {
  std::string plan, folder, input, order;
  std::size_t move = 0, before = 0, after = 0;  // 0: not given
  std::vector<std::string> directions;
  bool disassembly = false;
  ConfigFlags config;
  ConsoleOptions console;
};

/// Numbers that the user writes: of the assembly, or of the disassembly.
class StepNumbers {
 public:
  StepNumbers(const Plan& plan, bool disassembly) : plan_(plan), disassembly_(disassembly) {}
  std::size_t steps() const { return plan_.disassembly.size(); }
  /// Index in Plan::disassembly. @throws Error for a number that no step has.
  std::size_t index(std::size_t number) const {
    if (number < 1 || number > steps())
      throw Error(fmt::format("there is no step {}: the plan has {}", number, steps()));
    return disassembly_ ? number - 1 : steps() - number;
  }
  std::size_t number(std::size_t index) const { return step_number(plan_, index, disassembly_); }
  bool disassembly() const { return disassembly_; }
  std::string name(std::size_t index) const {
    std::string parts;
    for (const PlanMove& move : plan_.disassembly[index].moves) parts += (parts.empty() ? "" : ", ") + move.part;
    return fmt::format("step {} ({})", number(index), parts);
  }

 private:
  const Plan& plan_;
  bool disassembly_;
};

std::size_t number_in(const std::string& text, const std::string& option) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error(fmt::format("{}: '{}' is no number of a step", option, text));
  return number;
}

/// "3,1,2": in the order of the numbers' own mode; the result is in the order of the disassembly.
std::vector<std::size_t> listed(const std::string& text, const StepNumbers& steps) {
  std::vector<std::size_t> order;
  std::set<std::size_t> seen;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    order.push_back(steps.index(number_in(text.substr(begin, end - begin), "--order")));
    if (!seen.insert(order.back()).second)
      throw Error(fmt::format("--order: step {} is there twice", steps.number(order.back())));
    begin = end + 1;
  }
  for (std::size_t k = 0; k < steps.steps(); ++k)
    if (!seen.contains(k)) throw Error(fmt::format("--order: {} is missing; name every step once", steps.name(k)));
  if (!steps.disassembly()) std::reverse(order.begin(), order.end());
  return order;
}

/// The steps of the plan in the order of a CSV file, which is that of the assembly. Steps whose parts stand in one row
/// number keep their order.
std::vector<std::size_t> order_of_file(const std::string& file, const Plan& plan) {
  std::map<std::string, std::size_t> rank;
  const Order wanted = read_order(file);
  for (std::size_t k = 0; k < wanted.size(); ++k)
    for (const std::string& part : wanted[k].parts) rank[part] = k;
  const std::size_t steps = plan.disassembly.size();
  std::vector<std::size_t> order(steps), ranks(steps);
  for (std::size_t k = 0; k < steps; ++k) {
    const PlanStep& step = plan.disassembly[k];
    if (step.separates.empty())
      throw Error(fmt::format(
          "step {} of the disassembly moves parts that stay: name the steps by number (--order 3,1,2)", step.step));
    std::optional<std::size_t> found;
    for (const std::string& part : step.separates.front()) {
      const auto known = rank.find(part);
      if (known == rank.end()) throw InputError(file, fmt::format("it does not name '{}'", part));
      found = std::max(found.value_or(0), known->second);
    }
    ranks[k] = *found;
  }
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ranks[a] > ranks[b]; });
  return order;
}

/// Takes a step out of the order and puts it in again before or after another one, as seen in the numbers' own mode.
void move_step(std::vector<std::size_t>& order, const EditOptions& options, const StepNumbers& steps) {
  const std::size_t moved = steps.index(options.move);
  const std::size_t beside = steps.index(options.before != 0 ? options.before : options.after);
  if (moved == beside) throw Error(fmt::format("--move-step: step {} cannot be moved to itself", options.move));
  std::erase(order, moved);
  const auto place = std::find(order.begin(), order.end(), beside);
  const bool ahead = (options.before != 0) == steps.disassembly();  // in the order of the disassembly
  order.insert(ahead ? place : place + 1, moved);
}

PlanEdit edit_of(const EditOptions& options, const Plan& plan) {
  const StepNumbers steps(plan, options.disassembly);
  PlanEdit edit;
  if (options.order.ends_with(".csv")) {
    edit.order = order_of_file(options.order, plan);
  } else if (!options.order.empty()) {
    edit.order = listed(options.order, steps);
  } else {
    edit.order.resize(steps.steps());
    std::iota(edit.order.begin(), edit.order.end(), 0);
  }
  if (options.move != 0) move_step(edit.order, options, steps);
  for (const std::string& text : options.directions) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) throw Error(fmt::format("--direction: '{}' is not N=DIRECTION", text));
    const std::size_t step = steps.index(number_in(text.substr(0, equals), "--direction"));
    const auto direction = direction_named(text.substr(equals + 1));
    if (!direction)
      throw Error(fmt::format("--direction: '{}' is no direction: {}", text.substr(equals + 1), kDirections));
    if (edit.directions.contains(step))
      throw Error(fmt::format("--direction: step {} has two directions", steps.number(step)));
    edit.directions[step] = options.disassembly ? *direction : Eigen::Vector3d(-*direction);
  }
  return edit;
}

/// The settings that the plan was made with, unless others are named.
ConfigSource settings_of(const EditOptions& options) {
  ConfigSource source = options.config.source();
  const fs::path beside = fs::path(options.plan).replace_filename("resolved.yaml");
  std::error_code error;
  if (!source.file && fs::is_regular_file(beside, error)) source.file = beside;
  return source;
}

int refused(const StepRefused& e, const PlanEdit& edit, const StepNumbers& steps, Console& console) {
  const std::size_t index = edit.order[e.step()];
  console.text(fmt::format("refused: {} of the plan is not possible there: {}\nnothing was written\n",
                           steps.name(index), e.reason()));
  console.result({{"status", "refused"},
                  {"reason", "refused"},
                  {"step", steps.number(index)},
                  {"message", e.reason()},
                  {"plan", nullptr}});
  return kPartial;
}

int edit_plan(const EditOptions& options) {
  Console console(options.console);
  if (options.order.empty() && options.move == 0 && options.directions.empty())
    throw Error("nothing to change: use --order, --move-step or --direction");
  if ((options.move != 0) != (options.before != 0 || options.after != 0))
    throw Error("--move-step needs --before N or --after N, and these need --move-step");
  const Plan plan = read_plan(options.plan);
  if (!plan.asked.part.empty())
    throw Error(
        fmt::format("{} is the path of one part, '{}': there is no order to edit", options.plan, plan.asked.part));
  const PlanEdit edit = edit_of(options, plan);
  const fs::path folder = options.folder;
  std::error_code error;
  if (fs::equivalent(fs::absolute(options.plan).parent_path(), folder, error))
    throw Error(fmt::format("{} would be written over: name another folder with -o", options.plan));
  const Session session(settings_of(options));
  warn_of_problems(session, console);
  RunContext context = context_of(session, console);
  const LoadedAssembly loaded =
      stoppable(context, [&] { return session.load(source_of(plan, options.plan, options.input), context); });
  if (loaded.assembly->sha256 != plan.assembly.sha256)
    throw InputError(loaded.assembly->source, "the plan was made for other files (their SHA-256 differs)");
  std::optional<RunResult> result;
  try {
    const Disassembly steps = edited(plan, *loaded.assembly, edit);
    result = stoppable(context, [&] { return session.plan(loaded, context, {.steps = &steps}); });
  } catch (const StepRefused& e) {
    console.end_progress();
    return refused(e, edit, StepNumbers(plan, options.disassembly), console);
  }
  if (context.cancel.cancelled()) throw Stopped(context, "interrupted before all steps were verified");
  open_output_folder(folder);
  remove_old_results(folder, options.plan);
  write_file(folder / "resolved.yaml", session.resolved(folder));
  const auto files = write_all(*result, *loaded.assembly, folder, console);
  console.end_progress();
  const int status = status_of(*result, context);
  std::string text = summary_text(result->plan, options.console.verbose);
  const std::string costs = cost_change_words(plan.objective, result->plan.objective);
  if (!costs.empty()) text += costs + "\n";
  text += fmt::format("wrote to {}:", folder.string());
  for (const auto& file : files) text += " " + file;
  console.text(text + "\n");
  nlohmann::ordered_json json = result_json(*result, status, folder / "plan.json");
  const auto cost = [](const Plan& p) {
    return p.objective.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(p.objective.cost);
  };
  json["cost"] = cost(result->plan);
  json["cost_before"] = cost(plan);
  if (!costs.empty()) json["costs"] = costs;
  console.result(json);
  return status;
}

}  // namespace

void add_edit(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("edit", "Put the steps of a plan in another order, verified");
  auto options = std::make_shared<EditOptions>();
  command->add_option("PLAN.json", options->plan, "Plan written by 'dismantle plan' or 'dismantle edit'")
      ->required()
      ->option_text(" ");
  command->add_option("-o,--output", options->folder, "Folder for the edited plan; not that of PLAN.json")
      ->required()
      ->option_text("DIR");
  command
      ->add_option("--order", options->order,
                   "All steps in their new order, or a CSV file with the columns step and part")
      ->option_text("N,N,...|ORDER.csv");
  command->add_option("--move-step", options->move, "Move this step, with --before or --after")
      ->option_text("N")
      ->check(CLI::PositiveNumber.description(""));
  auto* before = command->add_option("--before", options->before, "With --move-step: in front of this step");
  before->option_text("N")->check(CLI::PositiveNumber.description(""));
  command->add_option("--after", options->after, "With --move-step: behind this step")
      ->option_text("N")
      ->check(CLI::PositiveNumber.description(""))
      ->excludes(before);
  command
      ->add_option("--direction", options->directions,
                   "Put the parts of this step in straight along +x, -z, or \"X Y Z\"; may be repeated")
      ->option_text("N=DIRECTION")
      ->type_size(1)
      ->allow_extra_args(false);
  command
      ->add_flag("--disassembly", options->disassembly,
                 "Numbers, --before and directions are those of the disassembly: parts leave in that direction")
      ->option_text(" ");
  command->add_option("--assembly", options->input, "Input of the plan if it has moved")->option_text("INPUT");
  options->config.add_file_and_set(*command);
  options->config.add_key(*command, "--threads", "run.threads", "N", "Threads, 0 = all cores");
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "Numbers are those of the assembly steps, as in the page and the book. Each step is verified again in its new\n"
      "place; what has to come first, the layout and the verdicts of the objective are found anew. Parts that the "
      "plan\n"
      "leaves together are tried again. Settings: resolved.yaml beside the plan, or -c.\n"
      "Exit status: 0 the edited plan does what was asked for; 1 not so, or a step is refused: it is named, and\n"
      "nothing is written.\n"
      "Examples:\n"
      "  dismantle edit gearbox.plan/plan.json --move-step 5 --before 3 -o edited\n"
      "  dismantle edit gearbox.plan/plan.json --direction 4=+z --direction 5=+z -o edited");
  command->callback([&action, options] { action = [options] { return edit_plan(*options); }; });
}

}  // namespace dismantle::app
