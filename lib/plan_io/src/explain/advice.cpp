#include "explain/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <optional>

namespace dismantle {
namespace {

/// A name as a word of the shell, in quotes only where it needs them.
std::string shell_word(const std::string& text) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || std::strchr("_./-", c) != nullptr; };
  if (!text.empty() && std::ranges::all_of(text, plain)) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

class Advisor {
 public:
  Advisor(const LeftReason& reason, const Plan& plan, const ExplainSettings& settings)
      : reason_(reason), plan_(plan), settings_(settings) {}

  std::vector<std::string> advice() {
    if (says("the constraints hold it back"))
      add("The order that you asked for holds it back: look at `constraints` (base, before, together, target).");
    else
      on_outcome();
    on_overlaps();
    return std::move(advice_);
  }

 private:
  void add(std::string text) { advice_.push_back(std::move(text)); }

  bool says(std::string_view words) const {
    return std::ranges::any_of(reason_.parts,
                               [&](const LeftPart& p) { return p.message.find(words) != std::string::npos; });
  }

  std::string value(const std::string& key) const {
    const auto found = settings_.find(key);
    return found == settings_.end() ? std::string() : found->second;
  }

  std::optional<double> number(const std::string& key) const {
    const std::string text = value(key);
    double x = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), x);
    if (text.empty() || read.ec != std::errc{} || read.ptr != text.data() + text.size()) return std::nullopt;
    return x;
  }

  /// "run.path_timeout (was 120 s)"
  std::string key(const std::string& name, const char* unit) const {
    const auto was = number(name);
    return was ? fmt::format("{} (was {:g}{})", name, *was, unit) : name;
  }

  /// Twice the old value, or `otherwise` if it is not known.
  double more(const std::string& name, double otherwise) const {
    const auto was = number(name);
    return was && *was > 0 ? 2 * *was : otherwise;
  }

  void longer_run() {
    add(fmt::format("Give the whole run more time: `--timeout {:g}`, key {}; 0 = no limit.", more("run.timeout", 14400),
                    key("run.timeout", " s")));
  }

  void longer_search() {
    const auto steps = number("run.path_steps");
    if (steps && *steps > 0)
      add(fmt::format("Give each search more steps: `--set run.path_steps={:.0f}`, key {}; 0 = no limit.", 2 * *steps,
                      key("run.path_steps", "")));
    if (number("run.path_timeout").value_or(1) > 0)
      add(fmt::format("Give each search more time: `--path-timeout {:g}`, key {}; 0 = no limit.",
                      more("run.path_timeout", 240), key("run.path_timeout", " s")));
  }

  void deeper() {
    const auto depth = number("sequence_planner.max_depth");
    if (depth && *depth > 0)
      add(fmt::format("Search deeper: `--set sequence_planner.max_depth={:.0f}`, key {}.", 2 * *depth,
                      key("sequence_planner.max_depth", "")));
    else if (!depth && settings_.empty())
      add("Search deeper: `--set sequence_planner.max_depth=N` (the value of the run stands in its resolved.yaml).");
  }

  void other_planner() {
    const std::string planner = value("path_planner.type");
    if (!planner.empty() && planner != "guided")
      add(fmt::format("Try the default path planner, which combines several: `--path-planner guided` (was {}).",
                      planner));
    if (const std::string sequence = value("sequence_planner.type"); !sequence.empty() && sequence != "blocking")
      add(
          fmt::format("Try the default sequence planner, which also moves groups and several parts together: "
                      "`--sequence-planner blocking` (was {}).",
                      sequence));
  }

  void tolerance(const std::string& why) {
    const double size = plan_.assembly.scale > 0 ? plan_.verified_max_penetration / plan_.assembly.scale : 0;
    add(
        fmt::format("{}: a larger `verify.max_penetration` than {:g} (a length in units of a tenth of the assembly's "
                    "largest edge; here {}) lets parts cut deeper into each other.",
                    why, plan_.verified_max_penetration, length_text(plan_, size)));
  }

  void leave_out() {
    const std::string& name = reason_.parts.front().part;
    add(
        fmt::format("Plan without one of them: `--set {}`; or keep what holds together as one: "
                    "`constraints: {{together: [[...]]}}`.",
                    shell_word(fmt::format("constraints.ignore=[\"{}\"]", name))));
  }

  void on_outcome() {
    switch (reason_.outcome) {
      case Outcome::timeout:
        if (says("whole run") || says("not tried") || says("not begun"))
          longer_run();
        else
          longer_search();
        other_planner();
        break;
      case Outcome::depth_limit:
        deeper();
        longer_search();
        other_planner();
        break;
      case Outcome::exhausted:
        other_planner();
        tolerance("If the fit is tight or snaps");
        break;
      case Outcome::infeasible:
        add("No other planner and no more time changes this: the parts as they are drawn cannot be separated as rigid "
            "bodies.");
        tolerance("If they are meant to snap or to bend");
        leave_out();
        break;
      case Outcome::invalid_start:
        add(fmt::format("`dismantle check {}` shows where parts overlap or have open surfaces.",
                        shell_word(plan_.assembly.source)));
        break;
      case Outcome::cancelled:
        add("Run again without interrupting it.");
        longer_run();
        break;
      case Outcome::unsupported:
        add("Choose another simulator (`--simulator ID`) or path planner (`--path-planner ID`): `dismantle plugins "
            "list`, "
            "`dismantle plugins describe ID`.");
        break;
      case Outcome::crashed:
        add("The plugin is faulty: `dismantle plugins check ID` tries it; `--path-planner guided` does without it.");
        break;
      case Outcome::solved:
      case Outcome::start_is_goal:
        break;
    }
  }

  void on_overlaps() {
    const bool any = std::ranges::any_of(reason_.parts, [](const LeftPart& p) {
      return std::ranges::any_of(p.blockers, [](const Blocker& b) { return b.overlap > 0; });
    });
    if (any && reason_.outcome != Outcome::invalid_start)
      add(fmt::format(
          "Parts overlap when assembled: `dismantle check {}` says where; what is drawn into each other often "
          "cannot leave.",
          shell_word(plan_.assembly.source)));
  }

  const LeftReason& reason_;
  const Plan& plan_;
  const ExplainSettings& settings_;
  std::vector<std::string> advice_;
};

}  // namespace

const char* meaning_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::solved:
      return "a path was found";
    case Outcome::start_is_goal:
      return "it was out already";
    case Outcome::timeout:
      return "the budget of time or steps was used up before a path was found";
    case Outcome::depth_limit:
      return "searched to the depth that was allowed, without finding a path";
    case Outcome::exhausted:
      return "nothing was left to search at this resolution";
    case Outcome::infeasible:
      return "proved: no motion separates it from what holds it";
    case Outcome::invalid_start:
      return "its start is not valid: it penetrates another part beyond what was measured";
    case Outcome::cancelled:
      return "the run was stopped";
    case Outcome::unsupported:
      return "the simulator cannot do what the planner needs";
    case Outcome::crashed:
      return "a plugin failed";
  }
  return "";
}

std::vector<std::string> advice_on(const LeftReason& reason, const Plan& plan, const ExplainSettings& settings) {
  return Advisor(reason, plan, settings).advice();
}

}  // namespace dismantle
