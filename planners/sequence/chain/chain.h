/// Sequence planners one after the other, each on what those before it have left.
#pragma once

#include <memory>
#include <vector>

#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"

namespace dismantle {

struct ChainParameters {
  std::vector<PluginRef<SequencePlanner>> of;
  double later_share = 0.15;
  /// Share of the remaining time that the first planners get for each group that a later planner has made.
  double retry_share = 0.25;
  /// Depth of the searches of the first planners in such a group.
  unsigned retry_depth = 3;
  static void describe(Schema<ChainParameters>& schema);
};

/// The first planner runs on the whole start. A later one runs on what is left. As soon as it has removed something,
/// the planners before it get the groups that this has made, with shallow searches; then it goes on.
class Chain final : public SequencePlanner {
 public:
  /// @throws std::invalid_argument when there is no planner, or a later one does not start from any arrangement.
  explicit Chain(const ChainParameters& params);
  SequencePlannerTraits traits() const noexcept override { return traits_; }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  ChainParameters params_;
  std::vector<std::shared_ptr<SequencePlanner>> planners_;
  SequencePlannerTraits traits_;
};

}  // namespace dismantle
