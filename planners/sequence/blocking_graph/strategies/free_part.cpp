#include "blocking_graph/strategies/free_part.h"

#include <span>

namespace dismantle::blocking {

Result FreePart::apply(GroupState& group) {
  const Subassemblies ids = group.members;
  for (std::size_t k = 0; k < ids.size() && !state_.stop(); ++k) {
    if (!state_.may_leave(group, {ids[k]})) continue;
    while (const auto d = straight_.free_direction(group, ids[k], std::span(ids).subspan(k + 1)))
      if (straight_.leave(group, {ids[k]}, *d)) return Result::restart;
  }
  return Result::unchanged;
}

}  // namespace dismantle::blocking
