#include "dismantle/plugin.h"

#include "mcts/mcts.h"

DISMANTLE_PLUGIN("dismantle.mcts", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::SequencePlanner, dismantle::Mcts, dismantle::MctsParameters>(
      "mcts", "Monte Carlo tree search over the order of searches, with estimates from the searches so far.",
      {.source = "Kocsis and Szepesvari 2006; suggested, for paths, by Tian et al. 2022, section 4.2"});
}
