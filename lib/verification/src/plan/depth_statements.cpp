#include "plan/depth_statements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dismantle/part_set.h"
#include "plan/violation_text.h"

namespace dismantle {

namespace {

/// Relative error that the plan format allows for a stated depth. So much of the tolerance is always allowed: less for
/// a forced step, whose depth is all that is known of it.
constexpr double kShare = 0.1;
constexpr double kOfTolerance = 2, kOfToleranceForced = 0.2;

}  // namespace

bool DepthStatements::agrees(double stated, double measured, double absolute) const {
  return std::abs(stated - measured) <= std::max(absolute, kShare * measured);
}

std::optional<std::string> DepthStatements::wrong(const PlanForced& said, const StepMotion& motion,
                                                  const std::vector<PlacedPart>& fixed, double& measured) {
  const double scale = assembly_.normalization.scale;
  const double absolute = kOfToleranceForced * verifier_.options().max_penetration;
  const auto found =
      meter_.deepest(motion.moving, fixed, motion.path, {.absolute = absolute / 2, .relative = kShare / 2}, context_);
  measured = found ? found->depth : 0;
  const double stated = said.depth * scale;
  if (agrees(stated, measured, absolute)) return {};
  // Of what was found in time, an overlap that grows, and another place: the excess is what can be compared.
  if (said.lower_bound && (stated - said.assembled * scale) <= (found ? found->excess() : 0) + absolute) return {};
  return fmt::format("it is forced and says that '{}' cuts {:.4g} into '{}'; measured: {:.4g}, '{}' into '{}'",
                     said.part, said.depth, said.other, measured / scale, found ? state_.name(found->part) : said.part,
                     found ? state_.name(found->other) : said.other);
}

std::optional<std::string> DepthStatements::wrong_valid_to(const PlanStep& said, const StepMotion& motion,
                                                           const std::vector<PlacedPart>& fixed) const {
  if (said.transfer == 0) return {};
  if (!said.forced) return "it states 'valid_to', and is not forced";
  if (said.transfer >= motion.path.size()) return "its 'valid_to' is no pose of its moves";
  const Path beginning(motion.path.begin(), motion.path.begin() + static_cast<std::ptrdiff_t>(said.transfer) + 1);
  const MotionCheck check = verifier_.check_motion(motion.moving, fixed, beginning, context_);
  if (check.valid || check.interrupted) return {};
  return fmt::format("it is forced and says that its motion is valid up to pose {}: {}", said.transfer,
                     violation_text(check.violation.value_or(Violation{}), assembly_));
}

std::optional<std::string> DepthStatements::wrong(const PlanStepOverlap& said, const StepMotion& motion,
                                                  const std::vector<PartId>& held) {
  const auto part = state_.find(said.part), other = state_.find(said.other);
  const auto column_of = [&](const std::optional<PartId>& id) {
    return id ? std::find(motion.moving.begin(), motion.moving.end(), *id) : motion.moving.end();
  };
  const auto column = column_of(part);
  if (!other || column == motion.moving.end() || column_of(other) != motion.moving.end())
    return fmt::format("it names an overlap of '{}' and '{}', and does not move the one past the other", said.part,
                       said.other);
  Path path;
  for (const auto& instant : motion.path)
    path.push_back({instant[static_cast<std::size_t>(column - motion.moving.begin())]});
  const double scale = assembly_.normalization.scale;
  MotionDepthOptions options{.absolute = verifier_.options().max_penetration, .relative = kShare / 2};
  if (contains(held, *other))
    options.at_most = assembly_.initial_overlap(*part, *other) + verifier_.options().max_penetration;
  const auto found = meter_.deepest({*part}, {{*other, state_.place[*other]}}, path, options, context_, true);
  const double measured = found ? found->depth : 0;
  if (const auto region = verifier_.overlap_region(*part, *other); region && said.region) {
    const Normalization& to = assembly_.normalization;
    const double off = std::max((to.to_internal(said.region->lo) - region->lo).cwiseAbs().maxCoeff(),
                                (to.to_internal(said.region->hi) - region->hi).cwiseAbs().maxCoeff());
    if (off > 2 * verifier_.options().max_penetration)
      return fmt::format("it says of '{}' and '{}' that they overlap elsewhere than measured", said.part, said.other);
  } else if (said.region && !region) {
    return fmt::format("it says where alone '{}' and '{}' may overlap; measured, there is no such place", said.part,
                       said.other);
  }
  if (agrees(said.depth * scale, measured, kOfTolerance * verifier_.options().max_penetration)) return {};
  return fmt::format("it says that '{}' is {:.4g} deep in '{}'; measured: {:.4g}", said.part, said.depth, said.other,
                     measured / scale);
}

std::optional<std::string> DepthStatements::wrong_flexible(const PlanAssembly& said) const {
  for (const PlanOverlap& o : said.overlaps) {
    if (!o.flexible) continue;
    const auto a = state_.find(o.a), b = state_.find(o.b);
    const InitialOverlap* found = a && b ? assembly_.overlap_of(*a, *b) : nullptr;
    if (found == nullptr || !found->declared || !o.declared ||
        !agrees(*o.declared, *found->declared, kOfTolerance * verifier_.options().max_penetration))
      return fmt::format("it takes '{}' or '{}' for flexible, and neither the file nor their shape and contact say so",
                         o.a, o.b);
  }
  for (const PlanPart& part : said.parts) {
    const auto of_part = [&](const PlanOverlap& o) { return o.flexible && (o.a == part.name || o.b == part.name); };
    const bool stated = std::any_of(said.overlaps.begin(), said.overlaps.end(), of_part);
    if (part.flexible && *part.flexible != Flexible::declared && !stated)
      return fmt::format("it takes '{}' for flexible ({}), and does not say towards which part", part.name,
                         to_string(*part.flexible));
  }
  return {};
}

}  // namespace dismantle
