/// Presents one group of an unfinished disassembly as an assembly of its own, so that any sequence planner can take it
/// apart.
#pragma once

#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/path_oracle.h"
#include "dismantle/sequence_planner.h"

namespace dismantle {

/// Answers questions about the parts of one group by asking the oracle of the whole assembly. Here the parts are
/// numbered from 0, and their current poses count as assembled. Searches are limited in depth, so that parts that could
/// not be removed before do not cause endless searches. Used by one sequence planner.
class GroupOracle final : public PathOracle {
 public:
  /// `group`: ascending by id. `most_depth` (>= 1) limits each search. The first two must outlive the oracle.
  GroupOracle(const Assembly& whole, PathOracle& oracle, std::vector<PlacedPart> group, unsigned most_depth);

  /// The parts of the group, as they are placed now, in the assembly units of the whole.
  const Assembly& assembly() const { return assembly_; }
  /// Converts a removal that this oracle answered to the whole assembly. @throws std::logic_error for other removals.
  Removal in_whole(const Removal& removal) const;

  const AttemptResult& attempt(const Attempt& attempt, RunContext& context) override;
  void prefetch(std::span<const Attempt> attempts, RunContext& context) override;
  const AttemptResult& propose(const Attempt& attempt, const Path& path, RunContext& context) override;
  OracleCounts counts() const override { return oracle_.counts(); }
  /// Null if a part is not at its original assembled pose: proofs of the whole oracle are about that pose.
  const Certificate* prove(const SeparationQuestion& question, const RunContext& context) override;
  double tolerance() const override { return oracle_.tolerance(); }
  const Constraints& constraints() const override { return constraints_; }

 private:
  /// The same pose in the group's frame and in the whole assembly's frame, so that conversion back and forth is exact.
  using Known = std::pair<Pose, Pose>;
  std::optional<PartId> local(PartId whole) const;  // nothing: not in the group
  Attempt to_whole(const Attempt& attempt) const;
  Pose to_whole(PartId part, const Pose& pose) const;
  Pose to_local(PartId part, const Pose& pose);
  std::vector<PartId> to_local(const std::vector<PartId>& parts) const;
  Constraints constraints_of_group(const Constraints& all) const;
  const AttemptResult& keep(const AttemptResult& answer);

  PathOracle& oracle_;
  std::vector<PlacedPart> group_;
  std::vector<bool> moved_;  // by local id: not where it was assembled
  unsigned most_depth_;
  Assembly assembly_;
  Constraints constraints_;
  std::vector<std::vector<Known>> known_;  // by local id
  std::deque<AttemptResult> results_;
  std::deque<Certificate> certificates_;
  std::map<const AttemptResult*, const AttemptResult*> local_of_, whole_of_;
  std::mutex proof_mutex_;  // of the next two
  std::deque<Certificate> proofs_;
  std::map<const Certificate*, const Certificate*> proof_of_;
};

}  // namespace dismantle
