#include "dismantle/plan_io/input_frame.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

struct LengthUnit {
  std::string_view name;
  double metres;
};
constexpr std::array kLengthUnits{LengthUnit{"um", 1e-6},      LengthUnit{"mm", 1e-3},     LengthUnit{"cm", 1e-2},
                                  LengthUnit{"dm", 0.1},       LengthUnit{"m", 1},         LengthUnit{"km", 1e3},
                                  LengthUnit{"mil", 2.54e-5},  LengthUnit{"inch", 0.0254}, LengthUnit{"foot", 0.3048},
                                  LengthUnit{"mile", 1609.344}};

bool is_gltf(std::string file) {
  std::ranges::transform(file, file.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return file.ends_with(".glb") || file.ends_with(".gltf");
}

template <class Parts>
InputFrame frame_of(const std::string& unit, const Parts& parts) {
  InputFrame out;
  out.y_up = !parts.empty() && std::ranges::all_of(parts, [](const auto& part) { return is_gltf(part.file); });
  out.unit_known = !unit.empty();
  out.unit = out.unit_known ? unit : out.y_up ? "m" : "mm";
  out.metres = metres_in(out.unit);
  return out;
}

}  // namespace

Eigen::Quaterniond InputFrame::to_y_up() const {
  if (y_up) return Eigen::Quaterniond::Identity();
  const double half = std::numbers::sqrt2 / 2;
  return {half, -half, 0, 0};
}

double metres_in(std::string_view unit) {
  std::string known;
  for (const LengthUnit& u : kLengthUnits) {
    if (u.name == unit) return u.metres;
    known += (known.empty() ? "" : ", ") + std::string(u.name);
  }
  throw InputError(std::string(unit), "is no unit of length that is known here; there are " + known);
}

InputFrame input_frame(const Assembly& assembly) { return frame_of(assembly.unit, assembly.parts); }
InputFrame input_frame(const PlanAssembly& assembly) { return frame_of(assembly.unit, assembly.parts); }

}  // namespace dismantle
