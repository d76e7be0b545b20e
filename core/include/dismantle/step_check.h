/// Step checks: is a step an assembly operation that somebody can carry out, and at what cost?
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dismantle/certificate.h"
#include "dismantle/disassembly.h"
#include "dismantle/export.h"
#include "dismantle/param_value.h"
#include "dismantle/run_context.h"
#include "dismantle/simulator.h"
#include "dismantle/step_note.h"

namespace dismantle {

/// One step of a disassembly, seen backwards: parts are put in. Assembly units; world frame as assembled.
struct StepQuestion {
  const Assembly& assembly;
  std::span<const PlacedPart> moving;   ///< the parts that are put in, where they are at the end of the operation
  std::span<const PlacedPart> present;  ///< the other parts of what has been built, where they are
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit; of the last stretch of the insertion
  const Trace* path = nullptr;  ///< of the insertion, columns as `moving`; null: only the direction is known
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit; how the assembly lies during the step
  const StepQuestion* previous = nullptr;  ///< the operation before it, itself without a previous one; null: none
};

/// The answer of a check.
struct StepVerdict {
  bool allowed = true;
  double cost = 0;     ///< >= 0, in the unit that the check documents
  std::string reason;  ///< not allowed, or a cost: why, for people
  std::vector<StepNote> notes{};
  std::optional<Certificate> certificate{};
};

/// What a check reads of StepQuestion::previous; nothing else of it may change the verdict. A search over sets of parts
/// carries just that as its state.
struct StepCheckTraits {
  bool remembers_direction = false;    ///< StepQuestion::direction
  bool remembers_orientation = false;  ///< StepQuestion::up
  bool remembers_shape = false;        ///< the moving parts
  bool judges_plan = false;            ///< judge_plan() says more than the sum of its steps
  /// False: StepQuestion::present, or StepQuestion::path, has no influence on the verdict. Costs are then known before
  /// an order is, which makes the bound of the cost of all orders better.
  bool reads_present = true, reads_path = true;
  bool estimates = false;  ///< estimate() may differ from judge()
};

/// Judges steps. The same question has the same verdict on any thread and at any time. const functions may be called
/// from several threads.
class DISMANTLE_API StepCheck {
 public:
  virtual ~StepCheck();
  virtual StepCheckTraits traits() const noexcept = 0;
  virtual StepVerdict judge(const StepQuestion& question, const RunContext& context) const = 0;
  /// What a search asks, for many steps of which few are taken: a check whose judge() takes more than a millisecond
  /// answers with an approximation, and says so in its traits. The plan states what judge() says.
  virtual StepVerdict estimate(const StepQuestion& q, const RunContext& context) const { return judge(q, context); }
  /// Judges a plan as a whole, for checks that say so in their traits. `operations` are in the order of assembly.
  virtual StepVerdict judge_plan(std::span<const StepQuestion> operations, const RunContext& context) const;
};

/// A check with its weight.
struct ObjectiveItem {
  std::string id;  ///< type of the check
  std::shared_ptr<const StepCheck> check;
  double weight = 1;      ///< >= 0; of its cost
  bool require = false;   ///< "not allowed" is a refusal instead of a cost
  ParamSet parameters{};  ///< that it was made with, for the plan to state
};

/// What an objective says of one step: the verdicts of its checks in their order.
struct ObjectiveVerdict {
  std::vector<StepVerdict> verdicts;
  double cost = 0;                       ///< weighted sum
  std::optional<std::size_t> refused{};  ///< index of the first check with `require` that does not allow the step
};

/// The checks that a plan is judged by. Empty: every order that is free of collisions is as good as another.
struct DISMANTLE_API Objective {
  std::vector<ObjectiveItem> items{};
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit; how the assembly lies
  bool empty() const { return items.empty(); }
  /// What is asked of a check.
  using Ask = StepVerdict (StepCheck::*)(const StepQuestion&, const RunContext&) const;
  /// `ask`: StepCheck::judge(), or, in searches, StepCheck::estimate().
  ObjectiveVerdict judge(const StepQuestion& question, const RunContext& context, Ask ask = &StepCheck::judge) const;
};

/// A removal as an assembly operation. `path`: of the removal, columns as `moved`; the parts start from `moved`.
class DISMANTLE_API Operation {
 public:
  Operation(const Assembly& assembly, std::vector<PlacedPart> moved, std::vector<PlacedPart> present, Trace removal,
            const Eigen::Vector3d& up);
  /// Refers to this operation, which must outlive it, and to `previous`.
  StepQuestion question(const StepQuestion* previous = nullptr) const;

 private:
  const Assembly& assembly_;
  std::vector<PlacedPart> moved_, present_;
  Trace insertion_;
  Eigen::Vector3d direction_, up_;
};

}  // namespace dismantle
