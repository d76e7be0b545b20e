// precedence.dot: what had to leave before what.
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "dismantle/plan_io/animation.h"

namespace dismantle {
namespace {

/// `text` as UTF-8, with U+FFFD in place of what is not.
std::string utf8(const std::string& text) {
  using Json = nlohmann::json;
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

/// Graphviz takes `\"` in every quoted string and expands `\\` in labels; control characters have no escape.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : utf8(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return out + '"';
}

}  // namespace

std::string to_dot(const Plan& plan, const std::vector<std::pair<std::string, std::string>>& precedence) {
  std::map<std::string, unsigned> left_in;
  for (const PlanStep& step : plan.disassembly)
    for (const auto& group : step.separates)
      for (const std::string& name : group) left_in.emplace(name, step.step);

  std::string out =
      "// a -> b: a left before b, and got in b's way while it was there.\n"
      "digraph precedence {\n"
      "  rankdir=LR;\n"
      "  node [shape=box, style=rounded, fontname=\"sans-serif\"];\n";
  for (const PlanPart& part : plan.assembly.parts) {
    const auto step = left_in.find(part.name);
    const bool leaves = step != left_in.end();
    const std::string label = leaves ? fmt::format("{}. {}", step->second, part.name) : part.name;
    out += fmt::format("  {} [label={}{}];\n", quoted(part.name), quoted(label),
                       leaves ? "" : ", style=\"rounded,filled\"");
  }
  for (const auto& [before, after] : precedence) out += fmt::format("  {} -> {};\n", quoted(before), quoted(after));
  return out + "}\n";
}

}  // namespace dismantle
