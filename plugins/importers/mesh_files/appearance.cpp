#include "appearance.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "dismantle/errors.h"
#include "text_scan.h"

namespace dismantle::mesh_files {
namespace {

/// sRGB encoding of IEC 61966-2-1.
double encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace

void OneColour::add(const std::optional<Rgba>& colour) {
  if (any_ && colour_ != colour) colour_.reset();
  if (!any_) colour_ = colour;
  any_ = true;
}

std::optional<Rgba> rgba(double r, double g, double b, double a, bool linear) {
  if (!std::isfinite(r) || !std::isfinite(g) || !std::isfinite(b) || !std::isfinite(a)) return std::nullopt;
  const auto byte = [](double x) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0))); };
  const auto channel = [&](double x) { return byte(linear ? encoded(std::clamp(x, 0.0, 1.0)) : x); };
  return Rgba{channel(r), channel(g), channel(b), byte(a)};
}

std::map<std::string, Rgba> read_material_library(const std::filesystem::path& file) {
  struct Values {
    double r = 0, g = 0, b = 0, opacity = 1;
    bool has_colour = false;
  };
  std::map<std::string, Values> read;
  Values* now = nullptr;
  const auto number = [](std::string_view& rest, double otherwise) {
    return to_double(take_word(rest)).value_or(otherwise);
  };
  try {
    LineReader lines(file);
    std::string_view line;
    while (lines.next(line)) {
      line = line.substr(0, line.find('#'));
      const std::string_view keyword = take_word(line);
      if (keyword == "newmtl") {
        now = &read[std::string(trimmed(line))];
      } else if (now != nullptr && keyword == "Kd") {
        now->has_colour = true;
        now->r = number(line, 0);
        now->g = number(line, now->r);
        now->b = number(line, now->r);
      } else if (now != nullptr && keyword == "d") {
        now->opacity = number(line, 1);
      } else if (now != nullptr && keyword == "Tr") {
        now->opacity = 1 - number(line, 0);
      }
    }
  } catch (const InputError&) {
    return {};  // appearance only: the mesh is usable without it
  }
  std::map<std::string, Rgba> out;
  for (const auto& [name, v] : read)
    if (const auto colour = rgba(v.r, v.g, v.b, v.opacity, false); v.has_colour && colour) out.emplace(name, *colour);
  return out;
}

}  // namespace dismantle::mesh_files
