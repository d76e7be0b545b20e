#include "participation.h"

#include "dismantle/search/placed_parts.h"

namespace dismantle::portfolio {

bool Participation::is_large(const Member& member) {
  if (!diagonals_) {
    const Aabb moving = path::box_of(query_.assembly, query_.scene.moving),
               fixed = path::box_of(query_.assembly, query_.scene.fixed);
    const bool known = !moving.empty() && !fixed.empty();
    diagonals_.emplace(known ? moving.size().norm() : 1, known ? fixed.size().norm() : 0);
  }
  return diagonals_->first > member.large * diagonals_->second;
}

bool Participation::deep_enough(const Member& member) {
  if (!depth_limited()) return true;
  const bool more = member.least_depth_large > member.least_depth && is_large(member);
  return query_.budget.max_depth >= static_cast<std::uint64_t>(more ? member.least_depth_large : member.least_depth);
}

bool Participation::takes_part(const Member& member, const PathPlannerTraits& traits) {
  if (!query_.goal.any_of.empty() && !traits.simultaneous_motion) return false;
  if (member.size != Size::any && is_large(member) != (member.size == Size::large)) return false;
  return !depth_limited() || (member.depth_limited && (member.when_refused || deep_enough(member)));
}

}  // namespace dismantle::portfolio
