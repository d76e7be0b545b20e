/// How deep a part lies: the fewest steps until it is out.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/constraints.h"
#include "dismantle/disassembly.h"
#include "dismantle/export.h"
#include "dismantle/run_context.h"
#include "dismantle/step_check.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// A step of a disassembly on the way to a part.
struct AccessStep {
  std::vector<PartId> parts;  ///< that leave
  Eigen::Vector3d direction =
      Eigen::Vector3d::Zero();  ///< unit; of the last stretch of the removal; zero: none is known
  bool forced = false;
};

/// The way to a part.
struct PartAccess {
  std::vector<PartId> unit;  ///< the part, and what is kept together with it; ascending
  std::vector<AccessStep>
      steps;  ///< verified, or forced as in the plan; the last one separates the part; empty: none is known
  std::size_t least_depth = 1;  ///< no order of the motions that were looked at has fewer steps
  bool optimal = false;         ///< there are so many steps
  std::optional<double>
      cost;               ///< of the steps by the objective, as far as it reads no path; none: there is no objective
  bool cheapest = false;  ///< no order with so many steps costs less
  std::size_t depth() const { return steps.size(); }
};

/// The steps of the plan that take apart what the part is in, until it is by itself.
DISMANTLE_API PartAccess access_as_planned(PartId part, const Disassembly& plan, const Constraints& constraints);

/// The ways to the parts of one assembly. The motions of parts are those of a plan, and translations along the
/// coordinate axes, the directions of the plan and the axes of the parts' own faces; the verifier confirms them, each
/// pair of parts once for all questions. A step takes out one part, or parts that are kept together, or a group as in
/// the plan.
class DISMANTLE_API Access {
 public:
  /// `plan`: of the whole assembly, as far as it came. All references must outlive this.
  Access(const Assembly& assembly, const Disassembly& plan, const Constraints& constraints, const Objective& objective,
         const Verifier& verifier, const RunContext& context);
  ~Access();
  /// When the context wants to stop: what the plan says.
  PartAccess to(PartId part);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dismantle
