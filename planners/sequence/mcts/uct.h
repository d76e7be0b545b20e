/// Monte Carlo tree search over orders of questions.
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
  double discount = 0.9;  ///< of a removal, for each question of mean cost up to it
  unsigned horizon = 64;  ///< questions of one simulation, at most
};

/// A part that may be asked for next, and what the search thinks of it.
struct Choice {
  PartId part = 0;
  std::uint64_t visits = 0;
  double value = 0;  ///< mean of the simulations that began with it, in [0, 1]
};

/// UCT (Kocsis and Szepesvari 2006). A node of the tree is a sequence of questions with their answers; below it are the
/// parts that are open then, and below these both answers, which are drawn by chance. A simulation goes down the tree
/// by upper confidence bounds, adds a node, and goes on with parts drawn in proportion to their chances. Its value is
/// the sum of all removals, each discounted by the cost of all questions up to it, as a share of what is possible.
///
/// The open parts, most visited first (of equals the lower id). Empty when none is open.
std::vector<Choice> choose(const Knowledge& knowledge, const UctSettings& settings, Rng& rng);

}  // namespace dismantle::mcts
