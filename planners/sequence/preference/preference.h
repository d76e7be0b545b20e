/// Which of several removals does the objective like best?
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dismantle/sequence_planner.h"

namespace dismantle {

/// A removal that could be made next. Without path and direction (zero) only what does not depend on them counts.
struct CandidateRemoval {
  std::vector<PlacedPart> moving, rest;                 ///< where they are; `rest`: what they leave
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit; of a straight removal
  const Trace* path = nullptr;                          ///< of the removal, columns as `moving`, if it is known
};

/// Costs of removals in the order of disassembly. The order of assembly is the reverse: the last recorded removal is
/// the operation after the candidate. So a candidate costs what it costs by itself, and what the last removal costs
/// more, or less, with the candidate as the operation before it.
class Preference {
 public:
  /// `query` must outlive this.
  explicit Preference(const SequenceQuery& query);
  /// False: the objective is empty, or a check failed. Then the functions below need not be called.
  bool active() const { return !objective_.empty() && !failed_; }
  /// Removals that a required check does not allow cost more than any other.
  double cost(const CandidateRemoval& candidate, const RunContext& context) const;
  /// Indices of the candidates, the one that the objective likes best first; otherwise in their order. When a check
  /// throws, which is logged as an error, they stay in their order from then on.
  std::vector<std::size_t> sorted(std::span<const CandidateRemoval> candidates, const RunContext& context) const;
  /// Records a removal along this path (columns as `moving`).
  void removed(const CandidateRemoval& removal, const Trace& path, const RunContext& context);

 private:
  /// False: it threw, now or before.
  bool guarded(const std::function<void()>& work, const RunContext& context) const;
  double cost(const StepQuestion& question, const RunContext& context) const;
  /// Of the operation alone.
  double cost_alone(const StepQuestion& question, const RunContext& context) const;

  const Assembly& assembly_;
  const Objective& objective_;
  bool remembers_ = false;  ///< the cost of an operation may depend on the one before it
  std::optional<Operation> last_;
  double last_alone_ = 0;        ///< cost of the last removal without an operation before it
  mutable bool failed_ = false;  ///< a check threw
};

}  // namespace dismantle
