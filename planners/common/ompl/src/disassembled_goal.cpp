#include "dismantle/ompl/disassembled_goal.h"

#include <algorithm>

#include "dismantle/ompl/targetless.h"

namespace dismantle::sampling {

void DisassembledGoal::sampleGoal(ompl::base::State* state) const {
  auto& sample = *static_cast<StateType*>(state);
  const StateType start = problem_.space().start();
  const auto exits = exits_by_distance(problem_, start);
  const unsigned k = next_++;
  if (k >= exits.size())
    if (const auto drawn = problem_.draw_disassembled(rng_)) {
      sample = *drawn;
      return;
    }
  sample = problem_.exit(start, exits[std::min<std::size_t>(k, exits.size() - 1)]);
}

}  // namespace dismantle::sampling
