/// The order in which the author of a file builds the assembly.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace dismantle {

/// One step of that order. A group that is built apart has steps of its own; all its parts are put in by one step of the
/// group that contains it.
struct ReferenceStep {
  unsigned step = 0;                              ///< from 1, within `group`
  std::vector<std::uint32_t> parts;               ///< that this step puts in, ascending: indices into the list of parts
  std::string group{};                            ///< what is built in this step; empty: the whole assembly
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit, world as assembled: how it lies while people do the step
};

}  // namespace dismantle
