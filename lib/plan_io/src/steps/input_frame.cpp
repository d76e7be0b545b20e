#include "dismantle/plan_io/input_frame.h"

#include <algorithm>
#include <cctype>
#include <numbers>

#include "dismantle/errors.h"
#include "dismantle/geometry/length_unit.h"

namespace dismantle {
namespace {

const Eigen::Quaterniond kOverItsFront{0, 1, 0, 0};  // upside down: right stays right

bool is_gltf(std::string file) {
  std::ranges::transform(file, file.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return file.ends_with(".glb") || file.ends_with(".gltf");
}

template <class Parts>
InputFrame frame_of(const std::string& unit, const Parts& parts) {
  InputFrame out;
  const bool gltf = !parts.empty() && std::ranges::all_of(parts, [](const auto& part) { return is_gltf(part.file); });
  if (gltf) out.up = Eigen::Vector3d::UnitY();
  out.unit_known = !unit.empty();
  out.unit = out.unit_known ? unit : gltf ? "m" : "mm";
  out.metres = metres_in(out.unit);
  return out;
}

}  // namespace

Eigen::Quaterniond InputFrame::to_y_up() const {
  if (up == Eigen::Vector3d::UnitY()) return Eigen::Quaterniond::Identity();
  const double half = std::numbers::sqrt2 / 2;
  return Eigen::Quaterniond(half, -half, 0, 0) * upright(up);
}

Eigen::Quaterniond InputFrame::lies(const std::optional<Eigen::Vector3d>& upwards) const {
  if (!upwards) return Eigen::Quaterniond::Identity();
  if (upwards->dot(up) < -1 + 1e-9) return upright(up).conjugate() * kOverItsFront * upright(up);
  return Eigen::Quaterniond::FromTwoVectors(*upwards, up);
}

Eigen::Quaterniond upright(const Eigen::Vector3d& up) {
  if (up == Eigen::Vector3d::UnitZ()) return Eigen::Quaterniond::Identity();
  if (up.z() < -1 + 1e-9) return kOverItsFront;
  return Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ());
}

TextUnit text_unit(const std::string& unit, const Aabb& box) {
  if (unit_named(unit).empty()) return {unit, 1};
  const std::string name = unit_for_people(unit, box.empty() ? 1 : box.size().maxCoeff());
  return {name, metres_in(unit) / metres_in(name)};
}

TextUnit text_unit(const InputFrame& frame, const Aabb& box, const std::string& unknown) {
  if (!frame.shown.empty()) return {frame.shown, frame.metres / metres_in(frame.shown)};
  return frame.unit_known ? text_unit(frame.unit, box) : TextUnit{unknown, 1};
}

InputFrame shown_in(InputFrame frame, const std::string& unit) {
  if (unit.empty()) return frame;
  (void)metres_in(unit);
  if (!frame.unit_known)
    throw InputError(
        unit, "lengths cannot be shown in this unit, because the input does not name its own: say it with --unit");
  frame.shown = unit_named(unit);
  return frame;
}

InputFrame input_frame(const Assembly& assembly) { return frame_of(assembly.unit, assembly.parts); }
InputFrame input_frame(const PlanAssembly& assembly) { return frame_of(assembly.unit, assembly.parts); }

InputFrame input_frame(const Plan& plan) {
  InputFrame out = input_frame(plan.assembly);
  if (!plan.objective.empty()) out.up = plan.objective.up;
  return out;
}

}  // namespace dismantle
