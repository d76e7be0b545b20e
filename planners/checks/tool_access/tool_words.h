/// Words for tools and fasteners in notes.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dismantle/tools/access.h"
#include "fastener_memo.h"

namespace dismantle::checks {

/// "from above", "from -x", "from (0.6, 0, 0.8)": where a tool comes from, while the assembly lies with `up` upwards.
/// `from`, `up`: unit vectors.
inline std::string from_text(const Eigen::Vector3d& from, const Eigen::Vector3d& up) {
  constexpr double same = 0.9998;  // cosine of a degree
  if (from.dot(up) > same) return "from above";
  if (from.dot(up) < -same) return "from below";
  for (int k = 0; k < 3; ++k)
    if (std::abs(from[k]) > same) return fmt::format("from {}{}", from[k] > 0 ? '+' : '-', "xyz"[k]);
  const auto rounded = [](double x) { return std::round(x * 100) / 100 + 0.0; };
  return fmt::format("from ({:g}, {:g}, {:g})", rounded(from.x()), rounded(from.y()), rounded(from.z()));
}

/// "'a', 'b' and 'c'".
inline std::string listed_names(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out += fmt::format("{}'{}'", i == 0 ? "" : i + 1 == names.size() ? " and " : ", ", names[i]);
  return out;
}

inline std::string drive_text(const tools::Fastener& f) {
  if (f.kind != fasteners::Kind::screw && f.kind != fasteners::Kind::nut)
    return fmt::format("{} of {:.3g} mm", fasteners::to_string(f.kind), f.size);
  return fmt::format("{} {:.4g}", fasteners::to_string(f.drive), std::round(20 * f.size) / 20);
}

/// "'screw_3' (M3x10, hex socket 2.5)".
inline std::string label(const std::string& name, const Driven& driven) {
  const std::string drive = drive_text(driven.fastener);
  return driven.size.empty() || driven.pressed ? fmt::format("'{}' ({})", name, drive)
                                               : fmt::format("'{}' ({}, {})", name, driven.size, drive);
}

inline std::string use_text(const tools::Tool& tool, const tools::Use& use) {
  return use.name.empty() ? tool.name : fmt::format("{}, {}", tool.name, use.name);
}

/// What the screw does, or the screw that a nut is on; null: nothing is known.
inline const fasteners::Fastening* fastening_about(const FastenerMemo& memo, const Driven& driven) {
  const bool nut = driven.fastener.kind == fasteners::Kind::nut;
  const std::optional<PartId> screw = nut ? memo.screw_in(driven.part) : driven.part;
  return screw ? memo.fastening_of(*screw) : nullptr;
}

/// Adds that to a note.
inline void add_fastening(const FastenerMemo& memo, const Driven& driven, std::string& text, nlohmann::json& data) {
  const fasteners::Fastening* f = fastening_about(memo, driven);
  if (f == nullptr) return;
  const std::vector<Part>& parts = memo.assembly().parts;
  const std::string words = fasteners::fastening_text(memo.assembly(), *f);
  if (words.empty()) return;
  text += fmt::format(" '{}' {}{}.", parts[f->screw].name, words.starts_with("driven") ? "is " : "", words);
  nlohmann::json& out = data["fastens"] = {{"screw", parts[f->screw].name}};
  for (const auto& [key, of] : {std::pair{"clamps", &f->clamps}, {"into", &f->into}, {"only", &f->only}})
    for (const PartId part : *of) out[key].push_back(parts[part].name);
}

inline nlohmann::json json_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace dismantle::checks
