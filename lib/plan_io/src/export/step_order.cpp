// Which step waits for which, as graphs.
#include <fmt/format.h>

#include "dismantle/errors.h"
#include "dismantle/plan_io/exports.h"
#include "dismantle/plan_io/markup.h"
#include "dismantle/plan_io/text_columns.h"
#include "export/dot_text.h"

namespace dismantle {
namespace {

/// Refuses plans without `after` and `layer`, whose steps would look independent.
void check_order_is_known(const Plan& plan) {
  for (const PlanStep& step : plan.disassembly)
    if (step.layer == 0)
      throw InputError(fmt::format("step {}", step.step),
                       "the plan does not say which steps wait for which (no 'layer'); plan the assembly again");
}

std::string xml_text(const std::string& raw) { return escaped_markup(utf8_text(raw)); }

}  // namespace

std::string step_order_dot(const Plan& plan) {
  check_order_is_known(plan);
  std::string out =
      "// a -> b: step b needs step a to have been done. Steps of one rank can be done in any order.\n"
      "digraph steps {\n"
      "  rankdir=LR;\n"
      "  node [shape=box, style=rounded, fontname=\"sans-serif\"];\n";
  for (const PlanStep& step : plan.disassembly) {
    const bool accepted = step.forced && !step.forced->accepted.empty();
    const char* mark = accepted ? " (accepted)" : step.forced ? " (forced)" : "";
    out += fmt::format("  s{} [label={}{}];\n", step.step,
                       dot_quoted(fmt::format("{}. {}{}", step.step, text::names_of(plan, step), mark)),
                       step.forced && !accepted ? ", color=red, fontcolor=red" : "");
  }
  for (const PlanStep& step : plan.disassembly)
    for (const unsigned before : step.after) out += fmt::format("  s{} -> s{};\n", before, step.step);
  return out + "}\n";
}

std::string step_order_graphml(const Plan& plan) {
  check_order_is_known(plan);
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\" "
      "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:schemaLocation=\"http://graphml.graphdrawing.org/xmlns "
      "http://graphml.graphdrawing.org/xmlns/1.0/graphml.xsd\">\n"
      "  <key id=\"label\" for=\"node\" attr.name=\"label\" attr.type=\"string\"/>\n"
      "  <key id=\"step\" for=\"node\" attr.name=\"step\" attr.type=\"int\"/>\n"
      "  <key id=\"layer\" for=\"node\" attr.name=\"layer\" attr.type=\"int\"/>\n"
      "  <key id=\"planner\" for=\"node\" attr.name=\"planner\" attr.type=\"string\"/>\n"
      "  <key id=\"max_penetration\" for=\"node\" attr.name=\"max_penetration\" attr.type=\"double\"/>\n"
      "  <graph id=\"steps\" edgedefault=\"directed\">\n";
  for (const PlanStep& step : plan.disassembly)
    out += fmt::format(
        "    <node id=\"s{}\">\n      <data key=\"label\">{}</data>\n      <data key=\"step\">{}</data>\n"
        "      <data key=\"layer\">{}</data>\n      <data key=\"planner\">{}</data>\n"
        "      <data key=\"max_penetration\">{}</data>\n    </node>\n",
        step.step, xml_text(text::names_of(plan, step)), step.step, step.layer, xml_text(step.planner), step.max_penetration);
  for (const PlanStep& step : plan.disassembly)
    for (const unsigned before : step.after)
      out += fmt::format("    <edge source=\"s{}\" target=\"s{}\"/>\n", before, step.step);
  return out + "  </graph>\n</graphml>\n";
}

}  // namespace dismantle
