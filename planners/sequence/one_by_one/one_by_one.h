/// Bookkeeping of sequence planners that take single parts, one after the other, off the one group that is left.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dismantle/sequence_planner.h"

namespace dismantle {

/// In which order parts are tried.
enum class PartOrder { small_first, as_given, large_first };

/// All parts in that order; by volume, equal ones as given.
std::vector<PartId> ordered_parts(const Assembly& assembly, PartOrder order);

class OneByOne {
 public:
  /// `parts`: all parts of the assembly, in the order in which left() gives them. All references must outlive this.
  OneByOne(const Assembly& assembly, std::vector<PartId> parts, PathOracle& oracle, SequenceObserver& observer,
           RunContext& context);

  const std::vector<PartId>& left() const { return left_; }
  bool done() const { return left_.size() <= 1; }
  /// True when the planner has to stop here. What is said of the parts left then speaks of the interruption.
  bool interrupted();
  /// Asks whether `part` can leave while all others left stay fixed, to `max_depth` (0 = no limit). When it can it
  /// is removed immediately. `next`: parts that will be asked for after it, should it stay; worked ahead on.
  Outcome attempt(PartId part, unsigned max_depth, std::span<const PartId> next = {});
  /// That of the last attempt; lives as long as the oracle. Null before the first.
  const AttemptResult* answer() const { return answer_; }
  /// The result as it stands.
  SequenceResult finish() const;

 private:
  Attempt question(PartId part, unsigned max_depth) const;
  Outcome outcome() const;

  const Assembly& assembly_;
  PathOracle& oracle_;
  SequenceObserver& observer_;
  RunContext& context_;
  std::vector<PartId> left_;
  std::vector<Removal> removals_;
  std::vector<std::optional<Unsolved>> last_;  // by part id: the last attempt that said something
  const AttemptResult* answer_ = nullptr;
  bool interrupted_ = false;
  Outcome why_ = Outcome::cancelled;
};

}  // namespace dismantle
