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

/// A step that was recorded. Step i makes group i + 1 (unless part_way); group 0 is what was never left.
struct RecordedStep {
  std::vector<PartId> parts;
  std::size_t from = 0;              ///< the group that they left
  std::shared_ptr<const Path> path;  ///< of the oracle's answer, or of several, one after the other
  bool part_way = false;             ///< the parts stay in `from`; no group is made
  std::optional<PartId> alone{};     ///< this one leaves; the others that moved stay in `from`

  /// Is `part`, which moved, out after the step?
  bool leaves(PartId part) const { return !part_way && (!alone || *alone == part); }
};

/// The deepest contact of a part, placed so, with each of the others that are left; ascending by the other part.
using ContactsOf = std::function<std::vector<Contact>(PartId part, const Pose& at)>;

/// A removal is recorded only if the oracle answered exactly this question with a success: these parts, where they
/// are now, past all the others of their group, where those are now. So no plan holds an unchecked path, whatever a
/// sequence planner does.
class PlanBuilder {
 public:
  PlanBuilder(const Assembly& assembly, const Oracle& oracle, const RunOptions& options, std::string planner_id);

  /// Appends one step to the plan, or, when the last one left the very same parts part-way, goes on with that one: for
  /// the reader of the plan it is one motion. @throws std::logic_error saying what is wrong with the removal; nothing
  /// has changed then.
  void record(const Removal& removal);

  const Plan& plan() const { return plan_; }
  /// Records a step that no oracle has accepted: `parts`, which are together in a group, leave the rest of it along
  /// `path` (columns as `parts`). `worst`: what was measured along it, to the end when `exact`. `proof`: that the pair of
  /// `worst` cannot be separated; may be null. @throws std::logic_error as record().
  void force(const std::vector<PartId>& parts, const Path& path, const MotionDepth& worst, bool exact,
             const Certificate* proof, double seconds);
  /// Groups of several parts that are asked to come apart, each with where its parts are.
  std::vector<std::vector<PlacedPart>> open_groups() const;
  std::size_t forced() const { return forced_; }
  const std::vector<RecordedStep>& recorded() const { return recorded_; }
  /// Parts whose group still has others: the group that was never left, then groups that came out whole.
  std::vector<PartId> left() const;
  bool complete() const;
  /// What `part` has around it: the others of its group, where they are now.
  std::vector<PlacedPart> around(PartId part) const;
  /// Nothing more is asked for: every group is one part or what is to stay together, or the target is out.
  bool fulfilled() const;
  /// Sets plan().unsolved, and plan().certificates, each once.
  /// `places` may be empty: then it is not known what a part touches where it came furthest.
  void set_unsolved(const std::vector<Unsolved>& unsolved, const ContactsOf& places = {});
  /// Drops what is unsolved of parts that have left since; certificates stay.
  void drop_solved();
  /// Sets `after` and `layer` of the disassembly steps; as needed_steps().
  void set_needed(const std::vector<std::vector<std::size_t>>& needed);
  /// Sets `overlaps` of the disassembly steps, [k] of the k-th.
  void set_overlaps(std::vector<std::vector<PlanStepOverlap>> overlaps);
  /// Sets plan().assembly_steps in place of the disassembly backwards.
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
  std::vector<std::vector<PartId>> groups_;  // the first is the one that was never left; [i + 1] made by step i
  std::vector<RecordedStep> recorded_;
  std::vector<const Certificate*> written_;  // those of plan_.certificates
  std::size_t forced_ = 0;
};

/// The disassembly step run backwards (Algorithm 3 from the disassembled poses).
PlanStep reversed(const PlanStep& step);

}  // namespace dismantle
