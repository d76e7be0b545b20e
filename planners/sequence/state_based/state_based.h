/// Translations before rotations, motion states that are kept for the whole run, and parts chosen by blocking graphs
/// enriched with states: in the manner of Lei, Lipovetzky and Ehinger (AAAI 2025).
#pragma once

#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"
#include "one_by_one/one_by_one.h"

namespace dismantle {

/// Which part is searched for first.
enum class StateBasedEvaluation { fewest_blockers, most_useful };

struct StateBasedParameters {
  PartOrder order = PartOrder::small_first;
  StateBasedEvaluation evaluation = StateBasedEvaluation::fewest_blockers;
  unsigned states = 24;
  /// Number of states that one translation leads to: at contact, and evenly spaced before it. Openings beside the path
  /// are found only with more than one.
  unsigned stops = 1;
  unsigned halvings = 12;  ///< Bisections to find where a translation meets a part: 12 resolve a 4096th of its length.
  /// Distance before contact at which a translation stops, in multiples of verify.max_penetration.
  double retreat = 1;
  /// Shortest translation that is kept, and least distance between two states; share of the part's diagonal.
  double least_step = 0.05;
  bool groups = false;
  /// Largest number of subassemblies proposed to the verifier before a group of parts is given up.
  unsigned group_proposals = 8;
  bool searches = true;
  bool resume = true;
  unsigned max_depth = 0;
  static void describe(Schema<StateBasedParameters>& schema);
};

class StateBased final : public SequencePlanner {
 public:
  explicit StateBased(const StateBasedParameters& params) : params_(params) {}
  SequencePlannerTraits traits() const noexcept override {
    return {.keeps_constraints = true, .any_start = true, .follows_objective = true};
  }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  StateBasedParameters params_;
};

}  // namespace dismantle
