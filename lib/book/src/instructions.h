/// What the pages of a book show: steps in the order of the work, sub-assemblies apart, seen from the part that stays.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/pose.h"

namespace dismantle {

/// Parts that move as one.
struct BookMover {
  std::vector<std::size_t> parts;                    ///< indices into Assembly::parts, ascending
  std::vector<Pose> poses;                           ///< in the order of the work; input units
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of their boxes, assembled; input units
};

struct PlacedPart {
  std::size_t part = 0;  ///< index into Assembly::parts
  Pose pose;             ///< input units
};

/// One step of the work. Poses are relative to the largest part that stays, which stands as assembled, so that
/// directions are those of the assembly however far a sub-assembly had been moved before it came apart.
struct BookStep {
  unsigned plan_step = 0;            ///< number of the disassembly step
  std::vector<PlacedPart> standing;  ///< what does not move
  std::vector<BookMover> movers;
  bool shifts_only = false;  ///< nothing joins or leaves: parts make room
};

struct BookChapter {
  std::vector<std::size_t> parts;  ///< ascending
  std::vector<std::size_t> base;   ///< of these, what is never taken from them
  std::vector<BookStep> steps;     ///< not empty
  int letter = -1;                 ///< of a sub-assembly, from 0 in the order of the chapters; -1: the whole
};

/// Assembling: a sub-assembly has its chapter before that of what it becomes part of. Taking apart: after. Within a
/// chapter the order is that of the plan, or its reverse.
/// @throws InputError when the plan names a part that the assembly does not have, or a step takes parts from two
/// groups.
std::vector<BookChapter> instructions(const Plan& plan, const Assembly& assembly, bool disassembly);

}  // namespace dismantle
