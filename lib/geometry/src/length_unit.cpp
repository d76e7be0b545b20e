#include "dismantle/geometry/length_unit.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

struct LengthUnit {
  std::string_view name;
  double metres;
  std::array<std::string_view, 3> others;  ///< lower-case, singular; American spelling is added by unit_named()
};
constexpr std::array kLengthUnits{LengthUnit{"um", 1e-6, {"micrometre", "micron", "µm"}},
                                  LengthUnit{"mm", 1e-3, {"millimetre"}},
                                  LengthUnit{"cm", 1e-2, {"centimetre"}},
                                  LengthUnit{"dm", 0.1, {"decimetre"}},
                                  LengthUnit{"m", 1, {"metre"}},
                                  LengthUnit{"km", 1e3, {"kilometre"}},
                                  LengthUnit{"mil", 2.54e-5, {"thou"}},
                                  LengthUnit{"inch", 0.0254, {"in", "inche"}},
                                  LengthUnit{"foot", 0.3048, {"ft", "feet"}},
                                  LengthUnit{"mile", 1609.344, {"mi"}}};

const LengthUnit* find(std::string_view text) {
  std::string word(text);
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (int form = 0; form < 2; ++form) {
    for (const LengthUnit& unit : kLengthUnits)
      if (unit.name == word || std::ranges::find(unit.others, word) != unit.others.end()) return &unit;
    if (word.size() > 3 && word.ends_with('s')) word.pop_back();
    if (word.ends_with("meter")) word.replace(word.size() - 2, 2, "re");
  }
  return nullptr;
}

}  // namespace

std::string unit_named(std::string_view text) {
  const LengthUnit* unit = text.empty() ? nullptr : find(text);
  return unit == nullptr ? std::string() : std::string(unit->name);
}

double metres_in(std::string_view unit) {
  if (const LengthUnit* known = unit.empty() ? nullptr : find(unit)) return known->metres;
  std::string names;
  for (const LengthUnit& u : kLengthUnits) names += (names.empty() ? "" : ", ") + std::string(u.name);
  throw InputError(std::string(unit), "is no unit of length that is known here; there are " + names);
}

std::string unit_of_length(double metres) {
  for (const LengthUnit& unit : kLengthUnits)
    if (std::abs(metres - unit.metres) <= 1e-5 * unit.metres) return std::string(unit.name);
  return {};
}

std::string unit_for_people(std::string_view unit, double size) {
  const double metres = size * metres_in(unit);
  const std::string name = unit_named(unit);
  if (name == "km") return "m";
  if (name == "dm" || (name == "m" && metres < 10)) return "mm";  // machines and furniture, not buildings
  return name;
}

}  // namespace dismantle
