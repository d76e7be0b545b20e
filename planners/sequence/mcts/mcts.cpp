#include "mcts/mcts.h"

#include <vector>

#include "one_by_one/one_by_one.h"

namespace dismantle {

void MctsParameters::describe(Schema<MctsParameters>& s) {
  s.add("simulations", &MctsParameters::simulations,
        {.unit = "1", .min = 1, .max = 1e9, .doc = "Simulated orders for each decision about the next search."});
  s.add(
      "exploration", &MctsParameters::exploration,
      {.unit = "1",
       .min = 0,
       .max = 1e3,
       .doc = "Weight of rarely visited parts against parts of high value: the constant of UCT. 0 = only the value."});
  s.advanced("discount", &MctsParameters::discount, {.min = 0, .max = 1, .min_open = true});
  s.advanced("horizon", &MctsParameters::horizon, {1, 1e6});
  s.add("max_depth", &MctsParameters::max_depth,
        {.unit = "1", .min = 0, .max = 1e6, .doc = "Largest depth of the path search; 0 = no limit."});
  s.add("max_attempts", &MctsParameters::max_attempts,
        {.unit = "1", .min = 0, .doc = "Largest number of searches in a run; 0 = no limit."});
}

SequenceResult Mcts::plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                          RunContext& context) {
  return each_group(query, [&](const std::vector<PlacedPart>& group) {
    OneByOne sequence(query.assembly, ordered_group(query.assembly, group, PartOrder::as_given), oracle, observer,
                      context);
    mcts::Knowledge knowledge(query.assembly.parts.size(), group, params_.max_depth);
    const mcts::UctSettings settings{params_.simulations, params_.exploration, params_.discount, params_.horizon};
    Rng rng = context.rng.fork(1);
    std::int64_t attempts = 0, simulations = 0;
    while (!sequence.done() && !sequence.interrupted()) {
      if (params_.max_attempts > 0 && attempts == params_.max_attempts) break;
      const std::vector<mcts::Choice> choices = mcts::choose(knowledge, settings, rng);
      if (choices.empty()) break;
      if (choices.size() > 1) simulations += params_.simulations;
      const PartId part = choices.front().part;
      // No other part could be tried instead of the last pair, so its searches have no depth limit.
      const bool last_pair = params_.max_depth == 0 && knowledge.left() == 2;
      const unsigned depth = last_pair ? 0 : knowledge[part].depth;
      std::vector<PartId> next;
      for (const mcts::Choice& c : choices)
        if (c.part != part && (last_pair || knowledge[c.part].depth == depth)) next.push_back(c.part);
      ++attempts;
      const Outcome outcome = sequence.attempt(part, depth, next);
      const PathResult& result = sequence.answer()->result;
      if (is_success(outcome))
        knowledge.removed(part, result.stats.cost);
      else
        knowledge.failed(part, outcome, result.blocked_by, result.stats.cost);
    }
    SequenceResult result = sequence.finish();
    result.counts["simulations"] = static_cast<double>(simulations);
    return result;
  });
}

}  // namespace dismantle
