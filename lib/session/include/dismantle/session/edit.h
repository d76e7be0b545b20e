/// A plan with its steps in another order, or along other directions. Nothing is verified here: Session::plan() with
/// PlanRequest::steps does that.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/disassembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// Changes of a plan. Steps are those of Plan::disassembly, numbered from 0.
struct PlanEdit {
  std::vector<std::size_t> order;                     ///< every step once, in the new order; empty: as it is
  std::map<std::size_t, Eigen::Vector3d> directions;  ///< unit; in which the parts of a step leave, straight
};

/// The edited steps. A path whose parts stand elsewhere than in the plan moves with them; one that ends straight is
/// lengthened until the hulls are apart. @throws StepRefused for a step that moves parts which are no longer together.
DISMANTLE_API Disassembly edited(const Plan& plan, const Assembly& assembly, const PlanEdit& edit);

}  // namespace dismantle
