#include "dismantle/statics/describe.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;

/// "+x", or the two largest of its axes, "+x and -z".
std::string axis_text(const Vec3& way) {
  constexpr double kNoticed = 0.38;  // the sine of 22.5 degrees
  const Vec3 unit = way.normalized();
  std::string text;
  for (int k = 0; k < 3; ++k)
    if (std::abs(unit[k]) > kNoticed)
      text += fmt::format("{}{}{}", text.empty() ? "" : " and ", unit[k] > 0 ? '+' : '-', "xyz"[k]);
  return text;
}

}  // namespace

std::string motion_text(const Body& body, const Motion& motion, const Vec3& down) {
  // A body that turns moves its upper end sideways; the speed of that end against the speed of its centre.
  const Vec3 top = motion.w.cross(-body.radius * down), sideways = top - top.dot(down) * down;
  if (sideways.norm() > 0.5 * motion.v.norm()) return "tips towards " + axis_text(sideways);
  if (motion.v.dot(down) > 0.8 * motion.v.norm()) return "falls down";
  const Vec3 level = motion.v - motion.v.dot(down) * down;
  return level.norm() > 0 ? "slides towards " + axis_text(level) : "turns";
}

}  // namespace dismantle::statics
