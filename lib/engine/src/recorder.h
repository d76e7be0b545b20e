/// Records the removals of a run as steps of its disassembly.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dismantle/disassembly.h"
#include "dismantle/engine/run.h"
#include "oracle.h"

namespace dismantle {

/// Records a removal only if the oracle answered exactly this question: these parts at their current poses, with all
/// others of their group at theirs. So no plan holds an unchecked path, whatever a sequence planner does.
class Recorder final : public SequenceObserver {
 public:
  /// All references must outlive this.
  Recorder(const Assembly& assembly, Oracle& oracle, const PlanningSetup& setup, const RunOptions& options,
           const StepObserver& on_step, const RunContext& context);

  /// Appends one step. If the last step was a placement of the same parts, extends it instead: the plan shows one
  /// motion. @throws std::logic_error with the problem of the removal, which stops the sequence planner; nothing has
  /// changed then.
  void removed(const Removal& removal, std::size_t /*parts_left*/) override { record(removal, nullptr); }
  /// Not further back than the first removal that this was given, and none of repeated().
  bool taken_back(std::size_t count) override;
  /// The same for a step that was planned before: what its search has found out stays as it was.
  void repeated(const Removal& removal, const DisassemblyStep& earlier) { record(removal, &earlier); }

  const Disassembly& disassembly() const { return disassembly_; }
  /// The first problem of a removal; empty: none.
  const std::string& problem() const { return problem_; }

 private:
  void record(const Removal& removal, const DisassemblyStep* earlier);
  void add(const Removal& removal, const DisassemblyStep* earlier);
  DisassemblyStep to_step(const Removal& removal) const;
  void check_question(const Removal& removal) const;
  /// Steps are added to the disassembly, and taken back, by these only.
  void append(DisassemblyStep step);
  void pop();
  void update(const std::vector<PartId>& moved);
  bool continues_last(const DisassemblyStep& step) const;

  const Assembly& assembly_;
  Oracle& oracle_;
  const PlanningSetup& setup_;
  const Constraints& constraints_;
  const StepObserver& on_step_;
  const RunContext& context_;
  Disassembly disassembly_;
  std::vector<Pose> poses_;  ///< by part, as they stand in questions: each removal is compared with those of its group
  std::vector<std::optional<DisassemblyStep>>
      before_;  ///< by removal that can be taken back: the step that it replaced
  std::string problem_;
};

}  // namespace dismantle
