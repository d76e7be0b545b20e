/// Monte Carlo tree search over orders of searches.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "mcts/knowledge.h"

namespace dismantle::mcts {

struct UctSettings {
  std::int64_t simulations = 200;  ///< for one decision
  double exploration = 0.7;
  double discount = 0.9;  ///< of a removal, per search of mean cost before it
  unsigned horizon = 64;  ///< most searches in one simulation
};

/// A part that may be searched for next, and its evaluation.
struct Choice {
  PartId part = 0;
  std::uint64_t visits = 0;
  double value = 0;  ///< mean of the simulations that began with it, in [0, 1]
};

/// UCT (Kocsis and Szepesvari 2006). A node of the tree is a sequence of searches with their results. Its children are
/// the open parts (decision nodes), and their children the two results (chance nodes). A simulation descends by upper
/// confidence bounds, adds a node, and continues with a rollout that draws parts in proportion to their probability of
/// success. Its value is the sum of all removals, each discounted by the cost spent before it, as a share of the
/// maximum.
///
/// The open parts, most visited first (of equals the lower id). Empty when none is open.
std::vector<Choice> choose(const Knowledge& knowledge, const UctSettings& settings, Rng& rng);

}  // namespace dismantle::mcts
