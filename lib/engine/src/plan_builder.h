/// Records the removals of a run: the pose and group of each part, and the resulting plan.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/engine/run.h"
#include "dismantle/plan.h"
#include "dismantle/verification/motion_depth.h"
#include "oracle.h"

namespace dismantle {

/// A recorded step. Step i makes group i + 1 (empty if part_way); group 0 holds the parts that never left.
struct RecordedStep {
  std::vector<PartId> parts;
  std::size_t from = 0;              ///< the group that they left
  std::shared_ptr<const Path> path;  ///< of the oracle's answer; of several answers, one after the other
  bool part_way = false;             ///< the parts stay in `from`; no group is made
  std::optional<PartId> alone{};     ///< only this part leaves; the other moved parts stay in `from`

  /// Does `part`, which moved, leave its group in this step?
  bool leaves(PartId part) const { return !part_way && (!alone || *alone == part); }
};

/// The deepest contact of a part at pose `at` with each other part of its group; ascending by the other part.
using ContactsOf = std::function<std::vector<Contact>(PartId part, const Pose& at)>;

/// Records a removal only if the oracle answered exactly this question with success: these parts at their current
/// poses, with all others of their group at theirs. So no plan holds an unchecked path, whatever a sequence planner
/// does.
class PlanBuilder {
 public:
  PlanBuilder(const Assembly& assembly, const Oracle& oracle, const RunOptions& options, std::string planner_id);

  /// Appends one step to the plan. If the last step was an intermediate placement of the same parts, extends it
  /// instead: the plan shows one motion. @throws std::logic_error with the problem of the removal; nothing has changed
  /// then.
  void record(const Removal& removal);

  const Plan& plan() const { return plan_; }
  /// Records a step that no oracle has accepted: `parts`, which are in one group, leave the rest of it along `path`
  /// (columns as `parts`). `worst`: depth measured along it, completely if `exact`. `proof` (may be null): the pair of
  /// `worst` cannot be separated. @throws std::logic_error as record().
  void force(const std::vector<PartId>& parts, const Path& path, const MotionDepth& worst, bool exact,
             const Certificate* proof, double seconds);
  /// Groups of several parts that still have to be separated, with the poses of their parts.
  std::vector<std::vector<PlacedPart>> open_groups() const;
  std::size_t forced() const { return forced_; }
  const std::vector<RecordedStep>& recorded() const { return recorded_; }
  /// Parts whose group still has others: first those of group 0, then those of groups that were removed as a whole.
  std::vector<PartId> left() const;
  bool complete() const;
  /// The other parts of the group of `part`, at their current poses.
  std::vector<PlacedPart> around(PartId part) const;
  /// True if nothing is left to do: every group is one part or is to stay together, or the target is out.
  bool fulfilled() const;
  /// Sets plan().unsolved, and plan().certificates, each once.
  /// `places` may be empty: then the contacts at the best poses are not known.
  void set_unsolved(const std::vector<Unsolved>& unsolved, const ContactsOf& places = {});
  /// Drops the unsolved entries of parts that have left since; certificates stay.
  void drop_solved();
  /// Sets `after` and `layer` of the disassembly steps; as needed_steps().
  void set_needed(const std::vector<std::vector<std::size_t>>& needed);
  /// Sets `overlaps` of the disassembly steps, [k] of the k-th.
  void set_overlaps(std::vector<std::vector<PlanStepOverlap>> overlaps);
  /// Replaces the reversed disassembly in plan().assembly_steps.
  void set_assembly(std::vector<PlanStep> steps, AssemblyStatus status, std::string message);

 private:
  std::optional<std::size_t> proof_against(const std::vector<PartId>& moving, const std::vector<PartId>& rest,
                                           const MotionDepth& worst) const;
  std::string why_forced(const std::vector<PartId>& parts, std::optional<std::size_t> proof) const;
  void check_constraints(const Removal& removal, const std::vector<PartId>& rest) const;
  bool stays_together(const std::vector<PartId>& group) const;
  std::vector<PartId>& group_of(const std::vector<PartId>& parts);
  PlanStep to_step(const Removal& removal) const;
  PlanCertificate to_plan(const Certificate& certificate) const;
  std::size_t index_of(const Certificate& certificate);
  bool goes_on(const Removal& removal, std::size_t from) const;
  void take_back_last(PlanStep& step, Path& path);
  void refresh_status();

  const Assembly& assembly_;
  const Oracle& oracle_;
  std::string planner_id_;
  Constraints constraints_;
  Plan plan_;
  std::vector<Pose> poses_;                  // by part id
  std::vector<std::vector<PartId>> groups_;  // [0]: parts that never left; [i + 1]: made by step i
  std::vector<RecordedStep> recorded_;
  std::vector<const Certificate*> written_;  // those of plan_.certificates
  std::size_t forced_ = 0;
};

/// The disassembly step run backwards (Algorithm 3 from the disassembled poses).
PlanStep reversed(const PlanStep& step);

}  // namespace dismantle
