/// Chooses the next part to search for by Monte Carlo tree search over estimates from the searches so far.

#pragma once

#include <cstdint>

#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"
#include "mcts/uct.h"

namespace dismantle {

struct MctsParameters {
  std::int64_t simulations = 200;
  double exploration = 0.7;
  /// Factor on the value of a removal for each search of mean cost before it. Smaller: prefers cheap searches; 1
  /// ignores costs.
  double discount = 0.9;
  unsigned horizon = 64;  ///< Largest number of searches in one simulated order.
  unsigned max_depth = 0;
  std::int64_t max_attempts = 0;
  static void describe(Schema<MctsParameters>& schema);
};

class Mcts final : public SequencePlanner {
 public:
  explicit Mcts(const MctsParameters& params) : params_(params) {}
  SequencePlannerTraits traits() const noexcept override { return {.any_start = true}; }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  MctsParameters params_;
};

}  // namespace dismantle
