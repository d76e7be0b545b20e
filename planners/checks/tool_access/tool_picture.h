/// The solid of a tool in its place, as data of a note: pages and books draw it.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "dismantle/tools/access.h"
#include "reach.h"
#include "tool_words.h"

namespace dismantle::checks {

/// In the form of the catalogue, [{"tube": {"radius", "inner", "z"}}, ...], in millimetres.
inline nlohmann::json json_of(const std::vector<tools::Volume>& volumes) {
  // To a micrometre: the sizes of an inch tool are long numbers.
  const auto mm = [](double x) { return std::round(1000 * x) / 1000 + 0.0; };
  const auto pair = [&](double a, double b) { return nlohmann::json{mm(a), mm(b)}; };
  nlohmann::json out = nlohmann::json::array();
  for (const tools::Volume& v : volumes) {
    const nlohmann::json z = pair(v.low, v.high);
    switch (v.form) {
      case tools::Form::tube:
        out.push_back({{"tube", {{"radius", mm(v.radius)}, {"inner", mm(v.inner)}, {"z", z}}}});
        break;
      case tools::Form::box:
        out.push_back({{"box", {{"x", pair(v.from.x(), v.to.x())}, {"y", pair(v.from.y(), v.to.y())}, {"z", z}}}});
        break;
      case tools::Form::obround:
        out.push_back({{"obround",
                        {{"from", pair(v.from.x(), v.from.y())},
                         {"to", pair(v.to.x(), v.to.y())},
                         {"radius", mm(v.radius)},
                         {"z", z}}}});
        break;
    }
  }
  return out;
}

/// {"origin", "mm", "travel", "tool", "hand"}: of the frame whose z axis is `from` and whose x axis is `handle` of the
/// same note. `origin` in input coordinates, `mm`: millimetres in an input unit.
inline nlohmann::json picture_of(const tools::Use& use, const tools::Fastener& fastener, const Eigen::Vector3d& origin,
                                 double mm, bool hand) {
  nlohmann::json out{{"origin", {origin.x(), origin.y(), origin.z()}},
                     {"mm", mm},
                     {"travel", std::round(1000 * fastener.travel) / 1000},
                     {"tool", json_of(tools::volumes_on(use.tool, use, fastener))}};
  if (hand && !use.hand.empty()) out["hand"] = json_of(tools::volumes_on(use.hand, use, fastener));
  return out;
}

/// Where a tool is, in the data of a note.
inline nlohmann::json place_of(const Assembly& assembly, const Driven& driven, const Reach& found, bool hand) {
  const double mm = found.fastener.mm * assembly.normalization.scale;
  return {{"part", assembly.parts[driven.part].name},
          {"tool", found.tool->id},
          {"name", found.tool->name},
          {"use", found.access.use->name},
          {"at", json_of(found.at)},
          {"from", json_of(found.axis)},
          {"handle", json_of(found.access.handle)},
          {"swing", found.access.use->swing},
          {"picture", picture_of(*found.access.use, found.fastener, found.seat, mm, hand)}};
}

}  // namespace dismantle::checks
