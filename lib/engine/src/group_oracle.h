/// One group of an unfinished disassembly as an assembly of its own, so that any sequence planner can take it apart.
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

/// Answers questions about the parts of one group, numbered from 0 and assembled where they are now, by asking the
/// oracle of the whole assembly. Searches are limited in depth, so that what has resisted before is not searched for
/// without end. Used by one sequence planner.
class GroupOracle final : public PathOracle {
 public:
  /// `group`: ascending by id. `most_depth` (>= 1): of a search. The first two outlive it.
  GroupOracle(const Assembly& whole, PathOracle& oracle, std::vector<PlacedPart> group, unsigned most_depth);

  /// The parts of the group, as they are placed now, in the assembly units of the whole.
  const Assembly& assembly() const { return assembly_; }
  /// A removal that was answered by this oracle, in terms of the whole assembly. @throws std::logic_error for others.
  Removal in_whole(const Removal& removal) const;

  const AttemptResult& attempt(const Attempt& attempt, RunContext& context) override;
  void prefetch(std::span<const Attempt> attempts, RunContext& context) override;
  const AttemptResult& propose(const Attempt& attempt, const Path& path, RunContext& context) override;
  OracleCounts counts() const override { return oracle_.counts(); }
  /// What is proved of parts as they were assembled holds only while they are still there.
  const Certificate* prove(const SeparationQuestion& question, const RunContext& context) override;
  double tolerance() const override { return oracle_.tolerance(); }
  const Constraints& constraints() const override { return constraints_; }

 private:
  /// A pose in the group's frame and the same pose in the whole's: going there and back loses no bit.
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
