#include "glb/glb_colours.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "dismantle/plan_io/plan_history.h"
#include "json/hex_colour.h"

namespace dismantle {
namespace {

/// sRGB component to the linear one that glTF wants.
double linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

/// Colour of the part that leaves as number `rank` of `count`: along the rainbow from red to violet, alternately light
/// and dark so that neighbours differ.
GlbJson colour_of(std::size_t rank, std::size_t count) {
  const double hue = 0.8 * 6.0 * (count > 1 ? double(rank) / double(count - 1) : 0.0);  // sixths of a turn
  const double value = rank % 2 == 0 ? 0.95 : 0.7, saturation = 0.7;
  GlbJson rgb = GlbJson::array();
  for (const double shift : {5.0, 3.0, 1.0}) {
    const double k = std::fmod(shift + hue, 6.0);
    rgb.push_back(static_cast<float>(linear(value * (1 - saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0)))));
  }
  rgb.push_back(1);
  return rgb;
}

GlbJson material(const std::string& name, GlbJson colour) {
  return {{"name", name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", std::move(colour)}, {"metallicFactor", 0.1}, {"roughnessFactor", 0.6}}}};
}

/// A part's own colour; light grey for one that has none.
GlbJson own_colour(const std::optional<Rgba>& colour) {
  const Rgba c = colour.value_or(Rgba{200, 200, 200});
  GlbJson out = GlbJson::array();
  for (const std::uint8_t channel : {c.r, c.g, c.b}) out.push_back(static_cast<float>(linear(channel / 255.0)));
  out.push_back(static_cast<float>(c.a / 255.0));
  return out;
}

/// Whether parts are shown in their own colours: most have one, and these tell parts apart. A CAD program that gives
/// every part the same grey has given none.
bool has_own_colours(const Assembly& assembly) {
  std::set<std::string> different;
  std::size_t coloured = 0;
  for (const Part& part : assembly.parts) {
    if (!part.colour) continue;
    ++coloured;
    different.insert(to_hex(*part.colour));
  }
  return 2 * coloured > assembly.parts.size() && different.size() > 1;
}

}  // namespace

std::vector<GlbPaint> paint_parts(const Plan& plan, const Assembly& assembly) {
  const PlanHistory history(plan);
  const bool own_colours = has_own_colours(assembly);
  std::set<std::string> forced;
  for (const PlanStep& step : plan.disassembly)
    if (step.forced)
      for (const PlanMove& move : step.moves) forced.insert(move.part);
  std::map<std::string, std::size_t> ranks;  // of parts that leave
  for (std::size_t i = 0; i < history.parts(); ++i)
    if (const auto rank = history.rank(i)) ranks.emplace(plan.assembly.parts[i].name, *rank);
  std::vector<GlbPaint> out;
  for (const Part& part : assembly.parts) {
    if (forced.contains(part.name)) {
      GlbJson red = material("forced", GlbJson::array({0.8, 0.01, 0.01, 1}));
      red["emissiveFactor"] = {0.3, 0, 0};
      out.push_back({std::move(red), nullptr});
      continue;
    }
    const auto rank = ranks.find(part.name);
    const bool stays = rank == ranks.end();
    GlbJson by_order = stays ? GlbJson::array({0.4, 0.4, 0.4, 1}) : colour_of(rank->second, history.leavers());
    if (!own_colours) {
      out.push_back({material(stays ? "stays" : part.name, std::move(by_order)), nullptr});
      continue;
    }
    GlbJson own = material(part.colour ? to_hex(*part.colour) : "no colour", own_colour(part.colour));
    if (part.colour && part.colour->a < 255) own["alphaMode"] = "BLEND";
    out.push_back({std::move(own), std::move(by_order)});
  }
  return out;
}

}  // namespace dismantle
