/// Columns of text for a terminal: what texts about plans, checks and preparations share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "dismantle/plan.h"

namespace dismantle::text {

/// Characters of a UTF-8 text.
inline std::size_t width_of(const std::string& utf8) {
  return static_cast<std::size_t>(std::ranges::count_if(utf8, [](char c) { return (c & 0xC0) != 0x80; }));
}

/// `text` padded with spaces to `width` characters.
inline std::string padded(std::string text, std::size_t width) {
  const std::size_t now = width_of(text);
  return now < width ? text.append(width - now, ' ') : text;
}

/// The width of a column of names: that of the widest, within [4, 40].
inline std::size_t column_of(std::size_t so_far, const std::string& name) {
  return std::max({so_far, std::size_t{4}, std::min<std::size_t>(width_of(name), 40)});
}

/// The names with commas between them.
inline std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

/// "1 part", "2 parts"
inline std::string counted(std::size_t n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

/// The names of the parts that a step moves.
inline std::string names_of(const PlanStep& step) {
  std::vector<std::string> names;
  for (const auto& move : step.moves) names.push_back(move.part);
  return joined(names);
}

/// Takes the parts of components that are kept and are there as a whole out of `parts`. Returns these components.
inline std::vector<const PlanComponent*> take_components(const PlanAssembly& assembly, std::vector<std::string>& parts) {
  std::vector<const PlanComponent*> out;
  const auto in = [](const std::vector<std::string>& list) {
    return [&list](const std::string& part) { return std::ranges::find(list, part) != list.end(); };
  };
  for (const PlanComponent& c : assembly.components) {
    if (!c.kept || !std::ranges::all_of(c.parts, in(parts))) continue;
    out.push_back(&c);
    std::erase_if(parts, in(c.parts));
  }
  return out;
}

/// The names of the parts that a step moves; a component of the file that moves as a whole has its own name.
inline std::string names_of(const Plan& plan, const PlanStep& step) {
  std::vector<std::string> parts, names;
  for (const auto& move : step.moves) parts.push_back(move.part);
  for (const PlanComponent* c : take_components(plan.assembly, parts)) names.push_back(c->name);
  names.insert(names.end(), parts.begin(), parts.end());
  return joined(names);
}

/// Columns for the parts of a step, so that all steps fit.
inline std::size_t widest_step(const Plan& plan) {
  std::size_t width = 4;
  for (const auto& step : plan.disassembly) width = column_of(width, names_of(plan, step));
  return width;
}

}  // namespace dismantle::text
