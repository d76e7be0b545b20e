/// Is the order in which people build an assembly possible?
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// What one step puts in: a part, or a group that was built before.
struct ReplayedItem {
  unsigned step = 0;
  std::string group;          ///< in which it is put in; empty: the whole assembly
  std::string item;           ///< the group that is put in; empty: a single part
  std::vector<PartId> parts;  ///< of the item
  bool possible = false;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< of the insertion, unit; where it cuts in least if refused
  PartId part = 0, other = 0;                           ///< refused: the pair that cuts deepest
  bool measured = false;                                ///< refused: else `depth` is a lower bound
  double depth = 0;  ///< refused: above the initial overlap, assembly units; 0: a proof failed
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< refused: where, assembly units
};

/// Goes through the order backwards: each item of a step, in whatever order of its items is possible, is pulled
/// straight out of what is there, along the coordinate axes and the axes of its own faces; the verifier confirms each
/// motion. Groups come out whole and are taken apart by themselves. A refused item is taken away without a motion.
/// Items in the order of removal; `seen` is told of each as it goes. Explaining takes a bounded number of measured
/// poses for each pair. Returns what was done when `context` wants to stop.
DISMANTLE_API std::vector<ReplayedItem> replay(const Assembly& assembly, const std::vector<ReferenceStep>& order,
                                               const Verifier& verifier, const RunContext& context,
                                               const std::function<void(const ReplayedItem&)>& seen = {});

}  // namespace dismantle
