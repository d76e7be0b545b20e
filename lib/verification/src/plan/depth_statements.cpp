#include "plan/depth_statements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dismantle {

namespace {

constexpr double kShare = 0.1;  // by which a stated depth may be off; twice the tolerance always

}  // namespace

bool DepthStatements::agrees(double stated, double measured) const {
  return std::abs(stated - measured) <= std::max(2 * verifier_.options().max_penetration, kShare * measured);
}

std::optional<std::string> DepthStatements::wrong(const PlanForced& said, const StepMotion& motion,
                                                  const std::vector<PlacedPart>& fixed) {
  const double scale = assembly_.normalization.scale;
  const auto found =
      meter_.deepest(motion.moving, fixed, motion.path, {verifier_.options().max_penetration, kShare / 2}, context_);
  const double measured = found ? found->depth : 0;
  if (agrees(said.depth * scale, measured)) return {};
  return fmt::format("it is forced and says that '{}' cuts {:.4g} into '{}'; measured: {:.4g}, '{}' into '{}'",
                     said.part, said.depth, said.other, measured / scale, found ? state_.name(found->part) : said.part,
                     found ? state_.name(found->other) : said.other);
}

std::optional<std::string> DepthStatements::wrong(const PlanStepOverlap& said, const StepMotion& motion) {
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
  const auto found = meter_.deepest({*part}, {{*other, state_.place[*other]}}, path,
                                    {verifier_.options().max_penetration, kShare / 2}, context_, true);
  const double measured = found ? found->depth : 0;
  if (agrees(said.depth * scale, measured)) return {};
  return fmt::format("it says that '{}' is {:.4g} deep in '{}'; measured: {:.4g}", said.part, said.depth, said.other,
                     measured / scale);
}

}  // namespace dismantle
