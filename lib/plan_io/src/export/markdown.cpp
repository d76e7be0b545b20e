// The steps of a plan as Markdown.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/exports.h"
#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/order_words.h"
#include "dismantle/plan_io/step_numbers.h"
#include "dismantle/plan_io/step_runs.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/text_columns.h"
#include "dismantle/plan_io/verdicts.h"
#include "export/dot_text.h"

namespace dismantle {
namespace {

/// A cell of a table: no line breaks; Markdown and HTML syntax is escaped.
std::string markdown_text(const std::string& raw) {
  std::string out;
  for (const char c : utf8_text(raw)) {
    if (std::string_view("\\`*_[]<>|~&#").find(c) != std::string_view::npos) out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

std::string steps_list(const std::vector<unsigned>& steps) {
  std::string out;
  for (const unsigned s : steps) out += fmt::format("{}{}", out.empty() ? "" : ", ", s);
  return out.empty() ? "-" : out;
}

/// Adds what is not there yet.
template <class Value>
void add_new(std::vector<Value>& to, const std::vector<Value>& values) {
  for (const Value& value : values)
    if (std::ranges::find(to, value) == to.end()) to.push_back(value);
}

/// Costs, refusals and notes of the checks, and what other places would cost; the same in several steps once.
std::string judged_cell(const Plan& plan, std::span<const PlanStep> steps) {
  std::vector<std::string> lines;
  for (const PlanStep& step : steps) {
    add_new(lines, cost_lines(step.checks));
    for (const PlanVerdict& v : step.checks)
      for (const StepNote& note : v.notes) add_new(lines, {fmt::format("{} ({})", note.text, note.kind)});
    if (const std::string other = other_place_words(plan, step.step - 1, true); !other.empty()) add_new(lines, {other});
  }
  std::string out;
  for (const std::string& line : lines) out += (out.empty() ? "" : "<br>") + markdown_text(line);
  return out.empty() ? "-" : out;
}

/// A row of the table: a step, or a run of several.
struct Together {
  std::string numbers, in_assembly, names;
  std::vector<unsigned> after;        // steps before it
  std::vector<std::string> contacts;  // parts that stay
};

Together together(std::span<const PlanStep> steps, const Plan& plan) {
  Together out;
  std::vector<std::string> moved;
  for (const PlanStep& step : steps) {
    for (const PlanMove& move : step.moves) moved.push_back(move.part);
    out.names += (out.names.empty() ? "" : "; ") + text::names_of(plan, step);
    add_new(out.after, step.after);
    add_new(out.contacts, step.contacts);
  }
  if (steps.size() > 1) {
    std::erase_if(out.after, [&](unsigned s) { return s >= steps.front().step; });
    std::ranges::sort(out.after);
    std::erase_if(out.contacts, [&](const std::string& part) { return std::ranges::find(moved, part) != moved.end(); });
  }
  const std::size_t first = static_cast<std::size_t>(steps.data() - plan.disassembly.data()),
                    last = first + steps.size() - 1;
  const auto range = [](std::size_t from, std::size_t to) {
    return from == to ? fmt::format("{}", from) : fmt::format("{}–{}", from, to);
  };
  out.numbers = range(step_number(plan, first, true), step_number(plan, last, true));
  out.in_assembly = range(step_number(plan, last, false), step_number(plan, first, false));
  return out;
}

/// A list, one line for each forced step.
std::string forced_reasons(const Plan& plan) {
  std::string out;
  for (std::size_t k = 0; k < plan.disassembly.size(); ++k) {
    const PlanStep& step = plan.disassembly[k];
    if (!step.forced) continue;
    std::string why;
    for (const std::string& text :
         {step.forced->reason, reached_text(plan, length_unit(plan), step), forced_advice(*step.forced)})
      if (!text.empty()) why += (why.empty() ? ": " : "; ") + markdown_text(text);
    if (why.empty()) continue;
    out += fmt::format("- Step {} ({} in assembly) cuts {} into {}{}.\n", step_number(plan, k, true),
                       step_number(plan, k, false), markdown_text(step.forced->part), markdown_text(step.forced->other),
                       why);
  }
  return out.empty() ? out : "\nWhy steps are forced:\n\n" + out;
}

/// How every step was found and verified; closed until the reader asks.
std::string details(const Plan& plan) {
  const PlanAssembly& a = plan.assembly;
  std::string out =
      "\n<details><summary>How the steps were found</summary>\n\n"
      "| step | found by | actions | seconds | cuts in at most |\n|---:|---|---:|---:|---:|\n";
  for (const PlanStep& step : plan.disassembly)
    out += fmt::format("| {} | {} | {} | {:.2f} | {:.2g} |\n", step.step,
                       step.planner.empty() ? "-" : markdown_text(step.planner), step.depth, step.seconds,
                       step.forced ? step.forced->depth * a.scale : step.max_penetration);
  const double size = a.box.empty() ? 1 : std::max(a.box.size().maxCoeff(), 1e-300);
  return out + fmt::format(
                   "\nDepths are in assembly units, of which the largest edge has {:.3g}; {:.2g} are allowed.\n\n"
                   "</details>\n",
                   size * a.scale, plan.verified_max_penetration);
}

/// What checks have written with their notes, for programs; closed until the reader asks. Empty without any.
std::string note_data(const Plan& plan) {
  std::string out;
  for (const PlanStep& step : plan.disassembly)
    for (const PlanVerdict& v : step.checks)
      for (const StepNote& note : v.notes)
        if (!note.data.empty())
          out += fmt::format("| {} | {} | {} | {} |\n", step.step, markdown_text(v.type), markdown_text(note.kind),
                             markdown_text(note.data));
  if (out.empty()) return out;
  return "\n<details><summary>Data of the notes</summary>\n\n| step | check | note | data |\n|---:|---|---|---|\n" +
         out + "\n</details>\n";
}

}  // namespace

std::string steps_markdown(const Plan& plan, const InputFrame& frame, const GuidedDistances& guided) {
  const PlanAssembly& a = plan.assembly;
  const TextUnit unit = text_unit(frame, a.box);
  const double size = a.box.empty() ? 1 : std::max(a.box.size().maxCoeff(), 1e-300);
  const Eigen::Vector3d middle = a.box.empty() ? a.center : a.box.center();

  std::string out =
      fmt::format("# {}\n\n{}, {}, {}.\n\n", markdown_text(a.source), text::counted(a.parts.size(), "part"),
                  text::counted(plan.disassembly.size(), "step"), markdown_text(result_text(plan)));
  const bool judged = !plan.objective.empty();
  if (judged) out += markdown_text(objective_text(plan)) + ".\n\n";
  if (!plan.disassembly.empty()) {
    const bool forced = plan.forced_steps() > 0;
    out += fmt::format(
        "| step | in assembly | parts | motion | waits for | touches |{}{}\n|---:|---:|---|---|---|---|{}{}\n",
        forced ? " cuts in |" : "", judged ? " as an assembly operation |" : "", forced ? "---:|" : "",
        judged ? "---|" : "");
    for (const StepRun& run : step_runs(plan, shapes_of(plan))) {
      const std::span<const PlanStep> steps = std::span(plan.disassembly).subspan(run.first, run.count);
      const PlanStep& step = steps.front();
      const std::size_t k = run.first;
      std::string motion = "-";
      if (!step.moves.empty()) {
        const std::vector<Pose>& poses = step.moves.front().poses;
        const MotionSummary summary = summarize_motion(poses, point_on_axis(poses, middle), stretch_tolerance(size));
        motion = travel_words(summary, guided.empty() ? std::nullopt : guided.at(k), {unit, frame.up, size, true},
                              frame.lies(step.up));
      }
      const Together all = together(steps, plan);
      const std::string what = step.separates.empty() ? " (shifted, stays)" : "";
      const std::string before = run.count > 1 ? run_words(plan, run) + ": " : "";
      std::string cuts;
      if (step.forced)
        cuts = fmt::format("**{}: {} {}**", step.forced->accepted.empty() ? "forced" : "accepted",
                           figure_text(unit.factor * step.forced->depth), unit.name);
      out += fmt::format("| {} | {} | {}{}{} | {} | {} | {} |{}{}\n", all.numbers, all.in_assembly,
                         markdown_text(before), markdown_text(all.names), what, markdown_text(motion),
                         step.layer > 0 ? steps_list(all.after) : "not recorded",
                         all.contacts.empty() ? "-" : markdown_text(text::joined(all.contacts)),
                         forced ? fmt::format(" {} |", cuts.empty() ? "-" : cuts) : "",
                         judged ? " " + judged_cell(plan, steps) + " |" : "");
    }
    out +=
        "\nSteps have their numbers in the disassembly; in the assembly, which is the same backwards, they have those "
        "of the "
        "second column. Motions are those of the first part named, at the assembly's middle, or on the axis about "
        "which "
        "it turns; ";
    out += guided.empty()
               ? "distances are the lengths of the verified paths, on which the hulls of the parts come apart.\n"
               : "the distance of a straight motion is that to where nothing is beside the part any more.\n";
    out += forced_reasons(plan) + details(plan) + note_data(plan);
  }
  if (!plan.remaining.empty()) out += fmt::format("\nStays: {}.\n", markdown_text(text::joined(plan.remaining)));
  if (!plan.unsolved.empty()) {
    out += "\n| not out | outcome | blocked by | said |\n|---|---|---|---|\n";
    for (const PlanUnsolved& u : plan.unsolved)
      out += fmt::format("| {} | {} | {} | {} |\n", markdown_text(u.part),
                         markdown_text(std::string(to_string(u.outcome))), markdown_text(text::joined(u.blocked_by)),
                         markdown_text(u.message));
  }
  if (!a.excluded.empty()) {
    out += "\n| left out | reason |\n|---|---|\n";
    for (const PlanExcluded& e : a.excluded)
      out += fmt::format("| {} | {} |\n", markdown_text(e.name), markdown_text(e.reason));
  }
  return out;
}

}  // namespace dismantle
