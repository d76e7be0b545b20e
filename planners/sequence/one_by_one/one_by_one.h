/// Bookkeeping for sequence planners that remove single parts, one after the other, from one group.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"
#include "preference/preference.h"

namespace dismantle {

/// In which order parts are tried.
enum class PartOrder { small_first, as_given, large_first };
/// Their names in configurations.
std::vector<EnumChoice<PartOrder>> part_orders();

/// The parts of a group in that order. Parts of equal volume stay in the order of the group.
std::vector<PlacedPart> ordered_group(const Assembly& assembly, std::vector<PlacedPart> group, PartOrder order);
/// All parts of the assembly in that order.
std::vector<PartId> ordered_parts(const Assembly& assembly, PartOrder order);

class OneByOne {
 public:
  /// `group`: in the order in which left() gives its parts. All references must outlive this.
  OneByOne(const Assembly& assembly, const std::vector<PlacedPart>& group, PathOracle& oracle,
           SequenceObserver& observer, RunContext& context);

  const std::vector<PartId>& left() const { return left_; }
  bool done() const { return left_.size() <= 1; }
  /// True if the run was cancelled or its time is up, so that the planner has to stop. finish() then says so.
  bool interrupted();
  /// Asks whether `part` can leave while all others left stay fixed, to `max_depth` (0 = no limit). If it can, it is
  /// removed immediately. `next`: parts to ask for if it cannot; computed speculatively.
  Outcome attempt(PartId part, unsigned max_depth, std::span<const PartId> next = {});
  /// Asks for each of these parts, as attempt() does, and then removes those that can leave, first the one that
  /// `preference` likes best. Paths stay valid when other parts have left: they are only verified again. Returns the
  /// outcomes of the questions.
  std::vector<Outcome> attempt_each(std::span<const PartId> parts, unsigned max_depth, Preference& preference);
  /// The answer to the last attempt; lives as long as the oracle. Null before the first attempt.
  const AttemptResult* answer() const { return answer_; }
  /// The result so far.
  SequenceResult finish() const;

 private:
  Attempt question(PartId part, unsigned max_depth) const;
  const AttemptResult& ask(PartId part, unsigned max_depth, std::span<const PartId> next);
  void remove(PartId part, const AttemptResult& answer);
  void note_failure(PartId part, const AttemptResult& answer);
  Outcome outcome() const;

  const Assembly& assembly_;
  PathOracle& oracle_;
  SequenceObserver& observer_;
  RunContext& context_;
  std::vector<PartId> left_;
  std::vector<Pose> poses_;  // by part id
  std::size_t steps_;        // when all of the group are out
  std::vector<Removal> removals_;
  std::vector<std::optional<Unsolved>> last_;  // by part id: last failure; an interrupted one only if it is the first
  const AttemptResult* answer_ = nullptr;
  bool interrupted_ = false;
  Outcome why_ = Outcome::cancelled;
};

/// Takes the groups of the start apart one after the other and joins the results.
SequenceResult each_group(const SequenceQuery& query,
                          const std::function<SequenceResult(const std::vector<PlacedPart>& group)>& take_apart);

}  // namespace dismantle
