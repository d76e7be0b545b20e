/// Bookkeeping for sequence planners that remove single parts, one after the other, from one group.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dismantle/sequence_planner.h"

namespace dismantle {

/// In which order parts are tried.
enum class PartOrder { small_first, as_given, large_first };

/// All parts in that order. Parts of equal volume stay in the order of the assembly.
std::vector<PartId> ordered_parts(const Assembly& assembly, PartOrder order);

class OneByOne {
 public:
  /// `parts`: all parts of the assembly, in the order in which left() gives them. All references must outlive this.
  OneByOne(const Assembly& assembly, std::vector<PartId> parts, PathOracle& oracle, SequenceObserver& observer,
           RunContext& context);

  const std::vector<PartId>& left() const { return left_; }
  bool done() const { return left_.size() <= 1; }
  /// True if the run was cancelled or its time is up, so that the planner has to stop. finish() then says so.
  bool interrupted();
  /// Asks whether `part` can leave while all others left stay fixed, to `max_depth` (0 = no limit). If it can, it is
  /// removed immediately. `next`: parts to ask for if it cannot; computed speculatively.
  Outcome attempt(PartId part, unsigned max_depth, std::span<const PartId> next = {});
  /// The answer to the last attempt; lives as long as the oracle. Null before the first attempt.
  const AttemptResult* answer() const { return answer_; }
  /// The result so far.
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
  std::vector<std::optional<Unsolved>> last_;  // by part id: last failure; an interrupted one only if it is the first
  const AttemptResult* answer_ = nullptr;
  bool interrupted_ = false;
  Outcome why_ = Outcome::cancelled;
};

}  // namespace dismantle
