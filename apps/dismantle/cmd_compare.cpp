// dismantle compare A B
#include <fmt/format.h>

#include "command.h"
#include "console.h"
#include "dismantle/orders/agreement.h"
#include "dismantle/plan_io/plan_file.h"

namespace dismantle::app {
namespace {

struct CompareOptions {
  std::string a, b;
  ConsoleOptions console;
};

/// An order, and which of its parts are equal.
struct Side {
  Order order;
  PartClasses classes;
};

Side side_of(const std::string& file) {
  if (!file.ends_with(".json")) return {read_order(file), {}};
  const Plan plan = read_plan(file);
  return {order_of(plan), classes_of(plan.assembly)};
}

nlohmann::ordered_json json_of(const std::string& file, const OrderMeasures& m) {
  return {{"file", file},
          {"steps", m.steps},
          {"parts", m.parts},
          {"direction_changes", m.direction_changes},
          {"off_axis", m.off_axis},
          {"reorientations", m.reorientations},
          {"equal_parts_torn", m.torn},
          {"travel", m.travel}};
}

int compare(const CompareOptions& options) {
  Console console(options.console);
  const Side a = side_of(options.a), b = side_of(options.b);
  PartClasses classes = a.classes;
  classes.insert(b.classes.begin(), b.classes.end());
  const Agreement agreement = agreement_of(a.order, b.order, classes);
  const OrderMeasures x = measures_of(a.order, classes), y = measures_of(b.order, classes);
  std::string text = fmt::format("{:<34}{:>14}{:>14}\n", "", "A", "B");
  const auto row = [&](const char* name, auto one, auto two) { text += fmt::format("{:<34}{:>14}{:>14}\n", name, one, two); };
  row("steps", x.steps, y.steps);
  row("parts", x.parts, y.parts);
  row("changes of direction", x.direction_changes, y.direction_changes);
  row("directions along no axis", x.off_axis, y.off_axis);
  row("changes of orientation", x.reorientations, y.reorientations);
  row("equal parts torn apart", x.torn, y.torn);
  row("travel, input units", fmt::format("{:.4g}", x.travel), fmt::format("{:.4g}", y.travel));
  text += agreement.tau ? fmt::format("tau-b {:.3f} of {} common parts\n", *agreement.tau, agreement.common)
                        : fmt::format("no tau-b: one order leaves all {} common parts together\n", agreement.common);
  console.text(text);
  console.result({{"status", "complete"},
                  {"tau", agreement.tau ? nlohmann::ordered_json(*agreement.tau) : nlohmann::ordered_json()},
                  {"common", agreement.common},
                  {"a", json_of(options.a, x)},
                  {"b", json_of(options.b, y)},
                  {"plan", nullptr}});
  return kComplete;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("compare", "Compare two orders of assembly");
  auto options = std::make_shared<CompareOptions>();
  command->add_option("A", options->a, "Plan (.json) or order (CSV: step, part, maybe direction)")->required()->option_text(" ");
  command->add_option("B", options->b, "The same")->required()->option_text(" ");
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "tau-b is Kendall's rank correlation of the parts that both have: 1 the same order, -1 the reverse. Parts of one\n"
      "step are ties; parts of one product can stand for each other; what is built apart stands where it is put in.\n"
      "Example:\n  dismantle compare out/plan.json mine.csv");
  command->callback([&action, options] { action = [options] { return compare(*options); }; });
}

}  // namespace dismantle::app
