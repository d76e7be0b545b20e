// dismantle replay MODEL|PLAN.json [--order ORDER.csv]
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/orders/agreement.h"
#include "dismantle/orders/replay.h"
#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/plan_file.h"
#include "settings.h"
#include "stopped.h"

namespace dismantle::app {
namespace {

struct ReplayOptions {
  std::string input, order;
  bool no_plan = false;
  ConfigFlags config;
  ConsoleOptions console;
};

/// The assembly with its reference order, and the plan that the order is compared with, if there is one.
struct Loaded {
  Assembly assembly;
  std::optional<Plan> plan{};
  LoadedAssembly model{};  ///< of which there is no plan yet
};

std::vector<ReferenceStep> order_from(const std::string& file, const Assembly& assembly) {
  std::map<std::string, PartId> ids;
  for (const Part& part : assembly.parts) ids.emplace(part.name, part.id);
  std::vector<ReferenceStep> order;
  for (const OrderStep& step : read_order(file)) {
    ReferenceStep& out = order.emplace_back();
    out.step = static_cast<unsigned>(order.size());
    for (const std::string& name : step.parts) {
      const auto known = ids.find(name);
      if (known == ids.end()) throw InputError(file, fmt::format("the assembly has no part '{}'", name));
      out.parts.push_back(known->second);
    }
    std::sort(out.parts.begin(), out.parts.end());
  }
  return order;
}

std::vector<PlanReferenceStep> named(const std::vector<ReferenceStep>& order, const Assembly& assembly) {
  std::vector<PlanReferenceStep> out;
  for (const ReferenceStep& step : order) {
    PlanReferenceStep& named = out.emplace_back(PlanReferenceStep{step.step, {}, step.group, step.up});
    for (const PartId id : step.parts) named.parts.push_back(assembly.parts[id].name);
  }
  return out;
}

std::vector<std::string> names_of(const ReplayedItem& item, const Assembly& assembly) {
  std::vector<std::string> names;
  for (const PartId id : item.parts) names.push_back(assembly.parts[id].name);
  return names;
}

nlohmann::ordered_json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::ordered_json item_json(const ReplayedItem& item, const Assembly& assembly) {
  nlohmann::ordered_json json = {{"step", item.step},
                                 {"group", item.group},
                                 {"parts", names_of(item, assembly)},
                                 {"possible", item.possible},
                                 {"direction", vector_json(item.direction)}};
  if (!item.item.empty()) json["item"] = item.item;
  if (item.possible) return json;
  json["pair"] = {assembly.parts[item.part].name, assembly.parts[item.other].name};
  json["depth"] = item.depth / assembly.normalization.scale;
  json["measured"] = item.measured;
  json["at"] = vector_json(assembly.normalization.to_input(item.at));
  return json;
}

std::string place_of(const ReplayedItem& item, const Assembly& assembly) {
  return fmt::format("step {}{}: {}", item.step, item.group.empty() ? "" : " of " + item.group,
                     item.item.empty() ? assembly.parts[item.parts.front()].name : item.item);
}

std::string item_text(const ReplayedItem& item, const Assembly& assembly) {
  if (item.possible)
    return fmt::format("possible: {}: put in along {}\n", place_of(item, assembly), axis_text(item.direction));
  const Eigen::Vector3d at = assembly.normalization.to_input(item.at);
  const std::string unit = assembly.unit.empty() ? "input units" : assembly.unit;
  const std::string part = assembly.parts[item.part].name;
  const std::string other =
      fmt::format("'{}' at ({:.4g}, {:.4g}, {:.4g})", assembly.parts[item.other].name, at.x(), at.y(), at.z());
  if (item.depth == 0)
    return fmt::format("refused: {}: nothing that cuts in was measured, but '{}' is not proved to pass {}\n",
                       place_of(item, assembly), part, other);
  return fmt::format(
      "refused: {}: '{}' cuts {}{:.3g} {} into {}, and deeper along every other direction that was "
      "tried\n",
      place_of(item, assembly), part, item.measured ? "" : "at least ", item.depth / assembly.normalization.scale, unit,
      other);
}

Loaded load(const ReplayOptions& options, const Session& session, RunContext& context) {
  if (options.input.ends_with(".json")) {
    LoadedPlan loaded = session.load_plan(options.input, {}, context);
    std::map<std::string, PartId> ids;
    for (const Part& part : loaded.assembly.parts) ids.emplace(part.name, part.id);
    for (const PlanReferenceStep& step : loaded.plan.assembly.reference_order) {
      ReferenceStep& out =
          loaded.assembly.reference_order.emplace_back(ReferenceStep{step.step, {}, step.group, step.up});
      for (const std::string& name : step.parts) out.parts.push_back(ids.at(name));
    }
    return {std::move(loaded.assembly), std::move(loaded.plan)};
  }
  LoadedAssembly model = session.load(options.input, context);
  Loaded out{*model.assembly};
  out.model = std::move(model);
  return out;
}

/// Parts that no step of the order puts in.
std::vector<std::string> left_over(const Assembly& assembly) {
  std::vector<std::string> names;
  for (const Part& part : assembly.parts)
    if (std::none_of(assembly.reference_order.begin(), assembly.reference_order.end(), [&](const ReferenceStep& step) {
          return std::find(step.parts.begin(), step.parts.end(), part.id) != step.parts.end();
        }))
      names.push_back(part.name);
  return names;
}

int replay_order(const ReplayOptions& options) {
  Console console(options.console);
  const Session session(options.config.source());
  warn_of_problems(session, console);
  RunContext context = context_of(session, console);
  Loaded loaded = stoppable(context, [&] { return load(options, session, context); });
  Assembly& assembly = loaded.assembly;
  if (!options.order.empty()) assembly.reference_order = order_from(options.order, assembly);
  if (assembly.reference_order.empty())
    throw InputError(options.input, "it states no order: name one with --order ORDER.csv (columns step, part)");
  VerifyOptions verify = session.config().verify;
  if (loaded.plan) verify.max_penetration = loaded.plan->verified_max_penetration;
  RunContext replaying = context;
  replaying.deadline = Deadline();  // the time limit is that of planning
  const Verifier verifier(assembly, verify, replaying);
  const std::vector<ReplayedItem> items =
      replay(assembly, assembly.reference_order, verifier, replaying, [&](const ReplayedItem& item) {
        console.text(item_text(item, assembly));  // as it goes
      });
  if (context.cancel.cancelled()) throw Stopped(context, "interrupted before all steps were tried");

  std::size_t refused = 0;
  auto list = nlohmann::ordered_json::array();
  for (const ReplayedItem& item : items) {
    list.push_back(item_json(item, assembly));
    if (!item.possible) ++refused;
  }
  console.text(fmt::format("{} of {} insertions of the order are possible, {} refused\n", items.size() - refused,
                           items.size(), refused));  // planning may take long
  const std::vector<std::string> others = left_over(assembly);
  if (!others.empty())
    console.text(fmt::format("not in the order, taken as there from the start: {}\n", fmt::join(others, ", ")));
  std::string text;
  if (!loaded.plan && !options.no_plan) {
    if (const double timeout = session.config().run.timeout; timeout > 0)
      context.deadline = Deadline::after_seconds(timeout);
    loaded.plan = session.plan(loaded.model, context).plan;
    console.end_progress();
  }
  nlohmann::ordered_json json = {
      {"status", refused == 0 ? "complete" : "partial"},
      {"reason", refused == 0 ? nlohmann::ordered_json() : nlohmann::ordered_json("refused")},
      {"parts", assembly.parts.size()},
      {"steps", assembly.reference_order.size()},
      {"possible", items.size() - refused},
      {"refused", refused},
      {"not_in_order", others},
      {"items", list}};
  if (loaded.plan) {
    const Agreement agreement = agreement_of(order_of(named(assembly.reference_order, assembly)),
                                             order_of(*loaded.plan), classes_of(loaded.plan->assembly));
    json["tau"] = agreement.tau ? nlohmann::ordered_json(*agreement.tau) : nlohmann::ordered_json();
    json["common"] = agreement.common;
    json["plan_status"] = std::string(to_string(loaded.plan->status));
    text += agreement.tau
                ? fmt::format("agreement with the order of the plan: tau-b {:.3f} ({} parts)\n", *agreement.tau,
                              agreement.common)
                : std::string("agreement with the order of the plan: one of them leaves all parts together\n");
  }
  json["plan"] = nullptr;
  console.text(text);
  console.result(std::move(json));
  return refused == 0 ? kComplete : kPartial;
}

}  // namespace

void add_replay(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("replay", "Try the order in which people build an assembly, step by step");
  auto options = std::make_shared<ReplayOptions>();
  command
      ->add_option("MODEL|PLAN.json", options->input,
                   "Model with building steps (LDraw), or any input with --order; or a plan of it")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--order", options->order,
                   "CSV file with the columns step and part: this order, not that of the model")
      ->option_text("ORDER.csv");
  command->add_flag("--no-plan", options->no_plan, "Do not plan a model to compare the orders");
  options->config.add_file_and_set(*command);
  options->config.add_key(*command, "--timeout", "run.timeout", "S", "Seconds for planning the model");
  options->config.add_key(*command, "--threads", "run.threads", "N", "Threads, 0 = all cores");
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "Goes through the order backwards, with sub-models as groups. What a step puts in is pulled straight out of "
      "what\n"
      "is there, and the verifier confirms it. A line for each; a refused one is explained: pair, depth, place. Writes "
      "nothing.\n"
      "Then a model is planned to say how much the two orders agree (Kendall's tau-b, 1 = the same order).\n"
      "Exit status: 0 all steps are possible, 1 some are refused.\n"
      "Examples:\n  dismantle replay truck.mpd\n  dismantle replay out/plan.json --order mine.csv");
  command->callback([&action, options] { action = [options] { return replay_order(*options); }; });
}

}  // namespace dismantle::app
