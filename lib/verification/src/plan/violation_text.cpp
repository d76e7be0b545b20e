#include "plan/violation_text.h"

#include <fmt/format.h>

namespace dismantle {

std::string violation_text(const Violation& violation, const Assembly& assembly) {
  const std::string &part = assembly.parts.at(violation.part).name, &other = assembly.parts.at(violation.other).name;
  const Eigen::Vector3d at = assembly.normalization.to_input(violation.point);
  const std::string where = fmt::format("between poses {} and {}, at [{:.6g}, {:.6g}, {:.6g}] of '{}'", violation.segment,
                                        violation.segment + 1, at.x(), at.y(), at.z(), part);
  if (violation.uncertain) return fmt::format("'{}' could not be shown to clear '{}' {}", part, other, where);
  const double scale = assembly.normalization.scale;
  const std::string depth =
      fmt::format("'{}' penetrates '{}' by {:.4g} {}", part, other, violation.depth / scale,
                  assembly.unit.empty() ? "input units" : assembly.unit);
  if (violation.elsewhere) return fmt::format("{} where they do not overlap when assembled, {}", depth, where);
  return fmt::format("{} ({:.4g} when assembled) {}", depth, violation.allowed / scale, where);
}

}  // namespace dismantle
