// dismantle access INPUT [--part PATTERN]...
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/orders/access.h"
#include "dismantle/plan_io/csv_text.h"
#include "dismantle/plan_io/text_columns.h"
#include "dismantle/preparation/name_pattern.h"
#include "dismantle/session/objective.h"
#include "dismantle/tools/repair_class.h"
#include "plan_report.h"
#include "settings.h"
#include "stopped.h"

namespace dismantle::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShown = 8;  // steps of each part, in text

struct AccessOptions {
  std::string input, format = "text";
  std::vector<std::string> parts;
  ConfigFlags config;
  ConsoleOptions console;
};

/// What was asked about: a part, or a component that is put in as one. And the way to it.
struct Answer {
  std::string name;
  PartAccess access;
  std::vector<tools::RepairClass> classes{};  ///< of the steps
  tools::RepairClass worst() const {
    tools::RepairClass all;
    for (const tools::RepairClass& c : classes) all.add(c);
    return all;
  }
  bool forced() const {
    return std::any_of(access.steps.begin(), access.steps.end(), [](const AccessStep& s) { return s.forced; });
  }
  bool reached() const { return !access.steps.empty(); }
};

std::vector<std::string> names_of(const std::vector<PartId>& parts, const Plan& plan) {
  std::vector<std::string> names;
  for (const PartId id : parts) names.push_back(plan.assembly.parts[id].name);
  return names;
}

/// The same; components that are there as a whole have their own names.
std::vector<std::string> unit_names(const std::vector<PartId>& parts, const Plan& plan) {
  std::vector<std::string> single = names_of(parts, plan), names;
  for (const PlanComponent* component : text::take_components(plan.assembly, single)) names.push_back(component->name);
  names.insert(names.end(), single.begin(), single.end());
  return names;
}

/// What has to come out before, step by step: what leaves in one step is joined by " + ".
std::vector<std::string> before(const Answer& answer, const Plan& plan) {
  std::vector<std::string> steps;
  for (std::size_t k = 0; k + 1 < answer.access.steps.size(); ++k)
    steps.push_back(fmt::format("{}", fmt::join(unit_names(answer.access.steps[k].parts, plan), " + ")));
  return steps;
}

Json answer_json(const Answer& answer, const Plan& plan) {
  const PartAccess& access = answer.access;
  Json json = {{"part", answer.name}};
  if (access.unit.size() > 1) json["together"] = names_of(access.unit, plan);
  json["depth"] = answer.reached() ? Json(access.depth()) : Json();
  json["least_depth"] = access.least_depth;
  json["optimal"] = access.optimal;
  json["forced"] = answer.forced();
  json["cost"] = access.cost ? Json(*access.cost) : Json();
  json["cheapest"] = access.cheapest;
  json["fasteners"] = to_string(answer.worst().fasteners);
  json["tools"] = to_string(answer.worst().tools);
  json["steps"] = Json::array();
  for (std::size_t k = 0; k < access.steps.size(); ++k) {
    const AccessStep& step = access.steps[k];
    Json& written = json["steps"].emplace_back(Json{{"parts", names_of(step.parts, plan)}});
    written["direction"] =
        step.direction.isZero() ? Json() : Json{step.direction.x(), step.direction.y(), step.direction.z()};
    written["fasteners"] = to_string(answer.classes[k].fasteners);
    written["tools"] = to_string(answer.classes[k].tools);
    if (step.forced) written["forced"] = true;
  }
  return json;
}

std::string csv_of(const std::vector<Answer>& answers, const Plan& plan) {
  std::string out = "part,depth,least_depth,optimal,forced,cost,cheapest,fasteners,tools,before\n";
  const auto yes = [](bool b) { return b ? "yes" : "no"; };
  for (const Answer& a : answers) {
    const std::string depth = a.reached() ? fmt::format("{}", a.access.depth()) : "";
    const std::string cost = a.access.cost ? fmt::format("{}", *a.access.cost) : "";
    out += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", csv_field(a.name), depth, a.access.least_depth,
                       yes(a.access.optimal), yes(a.forced()), cost, yes(a.access.cheapest),
                       to_string(a.worst().fasteners), to_string(a.worst().tools),
                       csv_field(fmt::format("{}", fmt::join(before(a, plan), "; "))));
  }
  return out;
}

/// "3"; "2 to 3", "<= 3": not proved to be the fewest; "-": no way is known.
std::string depth_text(const Answer& answer) {
  if (!answer.reached()) return "-";
  const std::size_t depth = answer.access.depth();
  if (answer.access.optimal) return fmt::format("{}", depth);
  if (answer.access.least_depth <= 1) return fmt::format("<= {}", depth);
  return fmt::format("{} to {}", answer.access.least_depth, depth);
}

std::string text_of(const std::vector<Answer>& answers, const Plan& plan) {
  std::size_t width = 4;
  for (const Answer& a : answers) width = std::max(width, text::width_of(a.name));
  std::string out =
      fmt::format("{}  {:>8}  {:>8}  {:<14}  {}\n", text::padded("part", width), "depth", "cost", "tools", "first out");
  std::size_t proved = 0, open = 0, forced = 0;
  for (const Answer& a : answers) {
    const std::string cost = a.access.cost ? fmt::format("{:.4g}", *a.access.cost) : "";
    std::vector<std::string> steps = before(a, plan);
    const std::size_t all = steps.size();
    if (all > kShown) steps.resize(kShown);
    std::string first = fmt::format("{}", fmt::join(steps, ", "));
    if (all > kShown) first += fmt::format(", and {} more", all - kShown);
    if (!a.reached()) first = "no way is known";
    if (a.forced()) first += " (by force)";
    std::string line = fmt::format("{}  {:>8}  {:>8}  {:<14}  {}", text::padded(a.name, width), depth_text(a), cost,
                                   a.reached() ? to_string(a.worst().tools) : "", first);
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
    proved += a.access.optimal ? 1 : 0;
    open += a.reached() ? 0 : 1;
    forced += a.forced() ? 1 : 0;
  }
  out += fmt::format("{}; the fewest steps are proved for {}", text::counted(answers.size(), "part"), proved);
  if (forced > 0) out += fmt::format(", {} only by force", forced);
  if (open > 0) out += fmt::format(", no way is known to {}", open);
  return out + "\n";
}

/// Units that are named, or all: name, and one part. @throws InputError for a pattern that nothing matches.
std::vector<std::pair<std::string, PartId>> asked_units(const AccessOptions& options, const Plan& plan,
                                                        const Constraints& constraints) {
  const std::vector<PartId> kept = kept_sets(plan.assembly.parts.size(), constraints);
  std::vector<std::vector<PartId>> units(kept.size());
  for (PartId id = 0; id < kept.size(); ++id) units[kept[id]].push_back(id);
  std::vector<std::string> unmatched = options.parts;
  std::vector<std::pair<std::string, PartId>> asked;
  for (PartId id = 0; id < kept.size(); ++id) {
    const std::vector<PartId>& unit = units[kept[id]];
    if (unit.front() != id) continue;
    std::vector<std::string> names = names_of(unit, plan);
    const std::string name = fmt::format("{}", fmt::join(unit_names(unit, plan), " + "));
    names.push_back(name);
    bool named = options.parts.empty();
    for (const std::string& pattern : options.parts)
      if (std::any_of(names.begin(), names.end(), [&](const auto& n) { return name_matches(n, pattern); })) {
        named = true;
        std::erase(unmatched, pattern);
      }
    if (named) asked.emplace_back(name, id);
  }
  if (!unmatched.empty())
    throw InputError(options.input, fmt::format("--part: no part is named '{}'", unmatched.front()));
  return asked;
}

/// Those of the run: with the components that it kept together.
Constraints constraints_of_run(const Session& session, const Assembly& assembly, const Plan& plan) {
  Constraints constraints = constraints_of(session.config().constraints, assembly);
  std::map<std::string, PartId> ids;
  for (const Part& part : assembly.parts) ids.emplace(part.name, part.id);
  constraints.together.clear();
  for (const std::vector<std::string>& names : plan.asked.together) {
    std::vector<PartId>& list = constraints.together.emplace_back();
    for (const std::string& name : names) list.push_back(ids.at(name));
  }
  return constraints;
}

int access(const AccessOptions& options) {
  Console console(options.console);
  ConfigSource source = options.config.source();
  source.set.push_back("layout.enabled=false");  // of no use here, as a better order of the whole
  source.set.push_back("run.best_order=false");
  const Session session(source);
  if (!session.config().constraints.target.empty())
    throw Error("the way to every part is looked for: name one with --part instead of constraints.target");
  warn_of_problems(session, console);
  session.check();
  RunContext context = context_of(session, console);
  const LoadedAssembly loaded = stoppable(context, [&] { return session.load(options.input, context); });
  const Assembly& assembly = *loaded.assembly;
  const Plan plan = session.plan_of(Disassembly(assembly.parts.size()), loaded);  // which parts are one component
  const Constraints constraints = constraints_of_run(session, assembly, plan);
  const auto units = asked_units(options, plan, constraints);
  const RunResult planned = stoppable(context, [&] { return session.plan(loaded, context); });

  RunContext looking = context;
  looking.deadline = Deadline();  // the time limit is that of planning
  const Objective objective =
      objective_of(session.config(), session.registry(), up_of(session.config().layout, assembly));
  std::optional<Verifier> verifier;
  std::optional<Access> routes;
  try {
    verifier.emplace(assembly, session.config().verify, looking);
    routes.emplace(assembly, planned.disassembly, constraints, objective, *verifier, looking);
  } catch (const Error&) {
    if (!looking.should_stop()) throw;
  }
  std::vector<Answer> answers;
  for (const auto& [name, part] : units) {
    looking.progress("access", answers.size() + 1, units.size(), name);
    answers.push_back({name, routes ? routes->to(part) : access_as_planned(part, planned.disassembly, constraints)});
    for (const AccessStep& step : answers.back().access.steps)
      answers.back().classes.push_back(tools::repair_class(assembly, step.parts, step.forced));
  }
  console.end_progress();

  const bool interrupted = context.cancel.cancelled();
  const std::vector<std::string> unusable = unusable_parts(plan);
  const bool all = std::all_of(answers.begin(), answers.end(), [](const Answer& a) { return a.reached(); });
  const bool forced = std::any_of(answers.begin(), answers.end(), [](const Answer& a) { return a.forced(); });
  const bool done = all && !forced && unusable.empty();
  Json json = {{"status", interrupted ? "interrupted" : !all ? "partial" : forced ? "forced" : "complete"}};
  json["parts"] = Json::array();
  for (const Answer& answer : answers) json["parts"].push_back(answer_json(answer, plan));
  json["unusable"] = unusable;
  if (options.format == "csv") {
    fmt::print("{}", csv_of(answers, plan));
  } else {
    std::string text = text_of(answers, plan);
    if (!unusable.empty())
      text += fmt::format("left out, because they could not be used: {}\n", fmt::join(unusable, ", "));
    if (interrupted) text += "interrupted: this is what was known until then\n";
    console.text(text);
  }
  console.result(std::move(json));
  return interrupted ? kInterrupted : done ? kComplete : kPartial;
}

}  // namespace

void add_access(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("access", "Say for each part how many steps it takes to get it out");
  auto options = std::make_shared<AccessOptions>();
  command->add_option("INPUT", options->input, "Folder of mesh files (one part each), or one file with several parts")
      ->required()
      ->option_text(" ");
  command->add_option("--part", options->parts, "Just these parts; * and ? stand for any characters; may be repeated")
      ->allow_extra_args(false)
      ->option_text("PATTERN");
  options->config.add_file_and_set(*command);
  options->config.add_components(*command);
  options->config.add_key(*command, "--seed", "run.seed", "N", "Seed");
  options->config.add_key(*command, "--timeout", "run.timeout", "S", "Seconds for planning, 0 = no limit");
  options->config.add_key(*command, "--threads", "run.threads", "N", "Threads, 0 = all cores");
  command
      ->add_option("--format", options->format,
                   "text, csv, or json: one JSON object as the last line of standard output")
      ->check(CLI::IsMember({"text", "csv", "json"}))
      ->option_text("text|csv|json");
  add_verbosity(*command, options->console);
  command->footer(
      "The depth of disassembly of EN 45554: the fewest steps until a part is out. A step takes out one part, or "
      "parts\n"
      "that are kept together. The assembly is planned once; what is in the way of what is found out once for all "
      "parts.\n"
      "A depth of \"2 to 3\" is not proved to be the least. Writes no files. Ctrl-C once stops soon and prints what is "
      "known.\n"
      "Exit status: 0 a way to each of these parts is known; 1 not so, or only by force, or some parts could not be "
      "used;\n"
      "2 usage or configuration; 3 unusable input; 4 a plugin failed; 130 interrupted.\n"
      "Examples:\n"
      "  dismantle access gearbox/\n"
      "  dismantle access laptop.step --part 'battery*' --part fan --format csv > depth.csv");
  command->callback([&action, options] {
    if (options->format == "json") options->console.format = Format::json;
    action = [options] { return access(*options); };
  });
}

}  // namespace dismantle::app
