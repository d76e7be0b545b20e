// dismantle stability INPUT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/geometry/direction.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/preparation/name_pattern.h"
#include "dismantle/session/objective.h"
#include "dismantle/statics/stability.h"
#include "settings.h"
#include "stability_file.h"
#include "stopped.h"

namespace dismantle::app {
namespace {

using Json = nlohmann::ordered_json;
using Vec3 = Eigen::Vector3d;

struct Stability {
  std::string input, folder;
  std::vector<std::string> fixed, density, mass, tilt;
  bool table = false, no_table = false;
  double friction = 0.4, budget = statics::kExtraWork / 1e9;
  unsigned hands = 0;
  ConfigFlags config;
  ConsoleOptions console;
};

/// @throws Error for a text that is no number.
double number_in(const std::string& text, const std::string& option) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || !std::isfinite(value))
    throw Error(fmt::format("{}: '{}' is not a number", option, text));
  return value;
}

/// "-y", or "0,0.5,1".
Vec3 direction_in(const std::string& text, const std::string& option) {
  const std::optional<Vec3> direction = direction_named(text);
  if (!direction) throw Error(fmt::format("{}: '{}' is no direction; write {}", option, text, kDirectionForms));
  return *direction;
}

/// "NAME=VALUE"; the name may contain '='.
std::pair<std::string, double> assignment_in(const std::string& text, const std::string& option) {
  const std::size_t at = text.rfind('=');
  if (at == std::string::npos || at == 0)
    throw Error(fmt::format("{}: write NAME=VALUE instead of '{}'", option, text));
  return {text.substr(0, at), number_in(text.substr(at + 1), option)};
}

/// Calls f(part) for each part whose name matches. @throws InputError when there is none.
template <class F>
void for_matching(const Assembly& assembly, const std::string& pattern, const std::string& option, F&& f) {
  bool any = false;
  for (const Part& part : assembly.parts)
    if (name_matches(part.name, pattern)) {
      f(part.id);
      any = true;
    }
  if (!any) throw InputError(assembly.source, fmt::format("{}: no part is named '{}'", option, pattern));
}

statics::StabilityOptions options_of(const Stability& asked, const Assembly& assembly) {
  statics::StabilityOptions options;
  options.fixed.resize(assembly.parts.size(), false);
  options.mass.resize(assembly.parts.size());
  for (const Part& part : assembly.parts) options.density.push_back(part.density.value_or(1));
  for (const std::string& pattern : asked.fixed)
    for_matching(assembly, pattern, "--fixed", [&](PartId id) { options.fixed[id] = true; });
  for (const std::string& text : asked.density) {
    const auto [name, value] = assignment_in(text, "--density");
    if (!(value > 0)) throw Error("--density: a density has to be above 0");
    for_matching(assembly, name, "--density", [&, value = value](PartId id) { options.density[id] = value; });
  }
  for (const std::string& text : asked.mass) {
    const auto [name, value] = assignment_in(text, "--mass");
    if (!(value > 0)) throw Error("--mass: a mass has to be above 0");
    for_matching(assembly, name, "--mass", [&, value = value](PartId id) { options.mass[id] = value; });
  }
  options.table = asked.table || (asked.fixed.empty() && !asked.no_table);
  options.friction = asked.friction;
  for (const std::string& text : asked.tilt) {
    const auto [axis, angle] = assignment_in(text, "--tilt");
    options.tilts.emplace_back(direction_in(axis, "--tilt"), angle * M_PI / 180);
  }
  return options;
}

std::string text_of(const Json& report, const Stability& asked) {
  const std::string verdict = report.at("verdict");
  std::string text =
      fmt::format("{}: {}\n", asked.input, verdict == "pressed_in" ? "stands only if it was pressed in" : verdict);
  if (verdict == "uncertain") {
    const std::string flips = report.at("flips_text");
    text += flips.empty() ? "No change was found that makes it certain.\n" : fmt::format("It changes: {}.\n", flips);
  }
  const auto names = [](const Json& list) {
    return fmt::format("{}", fmt::join(list.get<std::vector<std::string>>(), ", "));
  };
  if (!report.at("holds").empty())
    text += fmt::format("Hold {}{}.\n", names(report.at("holds")),
                        report.at("holds_proved") ? "; fewer holds are not enough" : "; fewer may be enough");
  for (const Json& why : report.at("why")) text += fmt::format("  {}\n", why.get<std::string>());
  for (const Json& m : report.at("moves")) {
    const auto d = m.at("direction").get<std::vector<double>>();
    text +=
        fmt::format("  {} moves towards ({:.2f}, {:.2f}, {:.2f})\n", m.at("part").get<std::string>(), d[0], d[1], d[2]);
  }
  if (verdict == "stands")
    for (const auto& [axis, angle] : report.at("critical_tilt_degrees").items())
      text += angle.is_null() ? fmt::format("Tilt about {}: stands up to 89 degrees.\n", axis)
                              : fmt::format("Tilt about {}: stands up to {:.1f} degrees.\n", axis, angle.get<double>());
  if (!report.at("least_push").empty()) {
    const Json& push = report.at("least_push").front();
    text += fmt::format("Least push: {}{:.3g} N on {}, which then {}.\n", push.at("exact") ? "" : "at most ",
                        push.at("newton").get<double>(), push.at("part").get<std::string>(),
                        push.at("how").get<std::string>());
  }
  for (const Json& f : report.at("by_friction"))
    text += fmt::format("Friction {:.1f}: {}\n", f.at("friction").get<double>(),
                        f.at("verdict").is_null() ? "not computed (budget)" : f.at("verdict").get<std::string>());
  for (const Json& what : report.at("not_checked")) text += fmt::format("{}\n", what.get<std::string>());
  return text;
}

/// The pile as a plan without steps: what the page shows. Its note says what falls and why, or that it stands.
Plan plan_of_pile(const Session& session, const LoadedAssembly& loaded, const statics::StabilityReport& report,
                  const Json& said, const Vec3& down) {
  const Assembly& assembly = *loaded.assembly;
  Plan plan = session.plan_of(Disassembly(assembly.parts.size()), loaded);
  plan.asked.together.emplace_back();
  for (const Part& part : assembly.parts) plan.asked.together.back().push_back(part.name);
  plan.status = PlanStatus::complete;  // it is looked at as it is
  const std::string verdict = said.at("verdict");
  std::string text = verdict == "stands"       ? "It stands."
                     : verdict == "pressed_in" ? "It stands only if it was pressed in."
                     : verdict == "falls"      ? "It falls."
                                               : "Whether it stands is uncertain.";
  constexpr std::size_t kTold = 4;
  for (std::size_t i = 0; i < std::min(kTold, report.why.size()); ++i) text += " " + report.why[i] + ".";
  if (report.why.size() > kTold) text += fmt::format(" {} more parts fall.", report.why.size() - kTold);
  if (!said.at("holds").empty())
    text += fmt::format(" Hold {}.", fmt::join(said.at("holds").get<std::vector<std::string>>(), ", "));
  Json data = {{"hold", Json::array()}, {"picture", Json::parse(statics::picture_of(report, assembly))}};
  for (const Json& part : said.at("holds")) data["hold"].push_back({{"part", part}});
  PlanVerdict whole;
  whole.type = "stability";
  whole.cost = static_cast<double>(said.at("holds").size());
  whole.notes.push_back({"hold", text, data.dump(-1, ' ', false, Json::error_handler_t::replace)});
  PlanObjectiveItem item;
  item.type = whole.type;
  item.cost = plan.objective.cost = whole.cost;
  item.plan = std::move(whole);
  plan.objective.up = -down;
  plan.objective.checks.push_back(std::move(item));
  return plan;
}

/// What is needed to find the same pile again.
Json model_json(const statics::StabilityOptions& options, const Assembly& assembly) {
  Json tilts = Json::array(), parts = Json::array();
  for (const auto& [axis, angle] : options.tilts)
    tilts.push_back({{"axis", {axis.x(), axis.y(), axis.z()}}, {"angle", angle}});
  for (const Part& p : assembly.parts) {
    Json part = {
        {"name", p.name}, {"fixed", static_cast<bool>(options.fixed[p.id])}, {"density", options.density[p.id]}};
    if (options.mass[p.id]) part["mass"] = *options.mass[p.id];
    parts.push_back(std::move(part));
  }
  return {{"table", options.table},
          {"friction", options.friction},
          {"up", {options.up.x(), options.up.y(), options.up.z()}},
          {"tilts", tilts},
          {"touching", options.touching},
          {"parts", parts}};
}

statics::StabilityOptions model_in(const Json& json, const Assembly& assembly) {
  const auto vector = [](const Json& v) {
    return Vec3(v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>());
  };
  statics::StabilityOptions options;
  options.table = json.at("table");
  options.friction = json.at("friction");
  options.up = vector(json.at("up"));
  options.touching = json.at("touching");
  for (const Json& tilt : json.at("tilts"))
    options.tilts.emplace_back(vector(tilt.at("axis")), tilt.at("angle").get<double>());
  const Json& parts = json.at("parts");
  if (parts.size() != assembly.parts.size()) throw InputError(assembly.source, "has other parts than the file states");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].at("name") != assembly.parts[i].name)
      throw InputError(assembly.source,
                       fmt::format("has no part '{}' in its place", parts[i].at("name").get<std::string>()));
    options.fixed.push_back(parts[i].at("fixed").get<bool>());
    options.density.push_back(parts[i].at("density").get<double>());
    options.mass.push_back(parts[i].contains("mass") ? std::optional(parts[i].at("mass").get<double>()) : std::nullopt);
  }
  return options;
}

int stability(const Stability& asked) {
  Console console(asked.console);
  if (!asked.folder.empty()) open_output_folder(asked.folder);
  const Session session(asked.config.source());
  warn_of_problems(session, console);
  RunContext context = context_of(session, console);
  const LoadedAssembly loaded = stoppable(context, [&] { return session.load(asked.input, context); });
  const Assembly& assembly = *loaded.assembly;
  statics::StabilityOptions how = options_of(asked, assembly);
  how.up = up_of(session.config().layout, assembly);
  const statics::AssemblyPile pile(assembly, std::move(how));
  const statics::StabilityReport report = statics::judge_assembly(
      pile, [&] { return context.should_stop(); }, 1e9 * asked.budget);
  console.end_progress();
  if (context.should_stop()) throw Stopped(context, "stopped before the pile was judged");
  Json json = Json::parse(statics::report_json(report, assembly, pile));
  console.text(text_of(json, asked));
  const bool stands = report.judgement.verdict == statics::Verdict::stands;
  const bool held = asked.hands > 0 && report.holds.found && report.holds.held.size() <= asked.hands;
  json["hands"] = asked.hands;
  json["stands_when_held"] = stands || held;
  if (!asked.folder.empty()) {
    Json file = {{"format", kStabilityFormat},
                 {"version", 1},
                 {"generator", {{"name", "dismantle"}, {"version", DISMANTLE_VERSION}}},
                 {"source", std::filesystem::absolute(asked.input).lexically_normal().string()},
                 {"sha256", assembly.sha256}};
    file["model"] = model_json(pile.options(), assembly);
    file.update(json);
    file["certificate"] = Json::parse(statics::certificate_json(report, assembly));
    const std::filesystem::path folder = asked.folder;
    write_file(folder / "stability.json", file.dump(1) + "\n");
    if (has_viewer())
      write_file(folder / "index.html",
                 page_of(plan_of_pile(session, loaded, report, json, report.pile.down), assembly));
  }
  Json result = {{"status", stands || held ? "complete" : "partial"},
                 {"reason", stands || held ? Json() : Json("does_not_stand")},
                 {"parts", assembly.parts.size()}};
  result.update(json);
  console.result(std::move(result));
  return stands || held ? kComplete : kPartial;
}

/// @throws InputError when the file cannot be read.
std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), {});
  if (!stream.good() && !stream.eof()) throw InputError(file.string(), "cannot be read");
  return text;
}

}  // namespace

bool is_stability_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  std::ifstream stream(file, std::ios::binary);
  std::string head(200, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(kStabilityFormat) != std::string::npos;
}

int verify_stability(const std::filesystem::path& file, const std::string& input, Console& console) {
  const std::string text = content_of(file);
  const Session session;
  warn_of_problems(session, console);
  RunContext context = context_of(session, console);
  try {
    const Json json = Json::parse(text);
    const std::string source = input.empty() ? json.at("source").get<std::string>() : input;
    const LoadedAssembly loaded = stoppable(context, [&] { return session.load(source, context); });
    const statics::AssemblyPile pile(*loaded.assembly, model_in(json.at("model"), *loaded.assembly));
    const std::string wrong = statics::check_stability_json(text, pile);
    console.end_progress();
    const std::string verdict = json.at("verdict");
    console.text(wrong.empty() ? fmt::format("{}: the certificate of '{}' holds\n", file.string(), verdict)
                               : fmt::format("{}: NOT VALID: {}\n", file.string(), wrong));
    Json problems = Json::array();
    if (!wrong.empty()) problems.push_back({{"message", wrong}});
    console.result({{"status", wrong.empty() ? "complete" : "invalid"},
                    {"reason", wrong.empty() ? Json() : Json("invalid")},
                    {"verdict", verdict},
                    {"problems", problems}});
    return wrong.empty() ? kComplete : kPartial;
  } catch (const nlohmann::json::exception& e) {
    throw InputError(file.string(), e.what());
  }
}

void add_stability(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("stability", "Find out whether a pile of parts stands, and what must be held");
  auto options = std::make_shared<Stability>();
  command->add_option("INPUT", options->input, "Folder of mesh files (one part each), or one file with several parts")
      ->required()
      ->option_text(" ");
  command->add_option("--fixed", options->fixed, "Parts that do not move; * and ? stand for any characters; repeatable")
      ->allow_extra_args(false)
      ->option_text("PATTERN");
  auto* table =
      command->add_flag("--table", options->table, "A table touches the lowest point (without --fixed: as usual)");
  command->add_flag("--no-table", options->no_table, "There is no table")->excludes(table);
  command->add_option("--friction", options->friction, "Coefficient of friction of all contacts (0.4)")
      ->check(CLI::Range(0.0, 10.0))
      ->option_text("MU");
  command->add_option("--density", options->density, "Density of parts in g/cm3 (that of the file, or 1); repeatable")
      ->allow_extra_args(false)
      ->option_text("NAME=G_PER_CM3");
  command->add_option("--mass", options->mass, "Mass of parts in kg; repeatable")
      ->allow_extra_args(false)
      ->option_text("NAME=KG");
  command->add_option("--tilt", options->tilt, "Turns the pile by the right-hand rule about an axis through the origin")
      ->allow_extra_args(false)
      ->option_text("AXIS=DEGREES");
  command->add_option("--hands", options->hands, "Hands that may hold parts: success if so many holds are enough (0)")
      ->option_text("N");
  command
      ->add_option("--budget", options->budget,
                   "Multiplications, in 10^9, that all answers beside the verdict may take together (150: some 40 s)")
      ->check(CLI::NonNegativeNumber)
      ->option_text("GIGA");
  command
      ->add_option("-o,--output", options->folder,
                   "Folder for stability.json, which verify takes, and index.html, which shows it")
      ->option_text("DIR");
  options->config.add_file_and_set(*command);
  options->config.add_key(*command, "--up", "layout.up", "x|y|z|-x|-y|-z|X,Y,Z",
                          "What is up in the input's coordinates");
  options->config.add_key(*command, "--threads", "run.threads", "N", "Threads, 0 = all cores");
  add_format(*command, options->console);
  add_verbosity(*command, options->console);
  command->footer(
      "Parts are rigid, friction is Coulomb's, gravity pulls against --up. Verdicts: stands, falls, pressed_in (forces "
      "in\n"
      "equilibrium exist, but nothing creates them), uncertain. Exit status: 0 it stands; 1 it does not, or is "
      "uncertain;\n"
      "3 the input cannot be used.\n"
      "Examples:\n"
      "  dismantle stability tower/\n"
      "  dismantle stability arch/ --fixed 'abutment*' --friction 0.55 --format json -q | tail -n 1");
  command->callback([&action, options] { action = [options] { return stability(*options); }; });
}

}  // namespace dismantle::app
