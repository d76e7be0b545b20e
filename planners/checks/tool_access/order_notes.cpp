#include "order_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reach.h"
#include "tool_words.h"

namespace dismantle::checks {
namespace {

std::vector<std::string> names_of(const FastenerMemo& memo, const std::vector<PartId>& parts) {
  std::vector<std::string> out;
  for (const PartId part : parts) out.push_back(memo.assembly().parts[part].name);
  return out;
}

}  // namespace

std::optional<StepNote> early_note(const FastenerMemo& memo, std::span<const PlacedPart> there, PartId screw) {
  const fasteners::Fastening* f = memo.fastening_of(screw);
  if (f == nullptr) return std::nullopt;
  const std::string& name = memo.assembly().parts[screw].name;
  const auto is_there = [&](PartId part) { return is_in(part, there); };
  if (!f->nut && !f->into.empty() && std::none_of(f->into.begin(), f->into.end(), is_there)) {
    const std::vector<std::string> into = names_of(memo, f->into);
    return StepNote{"tool_access.early",
                    fmt::format("'{}' is put in too early: it is driven into {}, which {} not there yet.", name,
                                listed_names(into), into.size() == 1 ? "is" : "are"),
                    nlohmann::json{{"screw", name}, {"missing", into}}.dump()};
  }
  std::vector<PartId> parts = f->clamps;
  std::erase_if(parts, is_there);
  if (parts.empty()) return std::nullopt;
  const std::vector<std::string> missing = names_of(memo, parts);
  return StepNote{"tool_access.early",
                  fmt::format("'{}' is tightened too early: it clamps {}, which {} not there yet.", name,
                              listed_names(missing), missing.size() == 1 ? "is" : "are"),
                  nlohmann::json{{"screw", name}, {"missing", missing}}.dump()};
}

StepNote early_nut_note(const FastenerMemo& memo, PartId nut, PartId screw) {
  const std::string &name = memo.assembly().parts[nut].name, &on = memo.assembly().parts[screw].name;
  return StepNote{"tool_access.early",
                  fmt::format("'{}' is put in too early: it is screwed onto '{}', which is not there yet, and nothing "
                              "keeps it in its place.",
                              name, on),
                  nlohmann::json{{"nut", name}, {"missing", {on}}}.dump()};
}

std::optional<StepNote> pattern_note(const FastenerMemo& memo, std::span<const PlacedPart> present, PartId screw) {
  const fasteners::Pattern* pattern = memo.pattern_of(screw);
  if (pattern == nullptr) return std::nullopt;
  for (const PartId other : pattern->screws) {
    const auto nut = memo.nut_of(other);
    if (other != screw && is_in(other, present) && (!nut || is_in(*nut, present))) return std::nullopt;
  }
  const std::vector<std::string> screws = names_of(memo, pattern->screws), clamps = names_of(memo, pattern->clamps);
  return StepNote{
      "tool_access.pattern",
      fmt::format(
          "{} equal screws ({}) clamp {}: put all of them in by hand first, then tighten them in cross order: {}.",
          screws.size(), pattern->size, listed_names(clamps), listed_names(screws)),
      nlohmann::json{{"screws", screws}, {"clamps", clamps}, {"size", pattern->size}}.dump()};
}

}  // namespace dismantle::checks
