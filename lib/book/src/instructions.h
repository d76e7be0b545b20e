/// Steps of a book in the order of the work: one chapter per sub-assembly, poses relative to the part that stays.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/drawn_tools.h"
#include "dismantle/pose.h"

namespace dismantle {

/// Parts that move as one rigid body.
struct BookMover {
  std::vector<std::size_t> parts;                    ///< indices into Assembly::parts, ascending
  std::vector<Pose> poses;                           ///< in the order of the work; input units
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of their common box, assembled; input units
};

struct PlacedPart {
  std::size_t part = 0;  ///< index into Assembly::parts
  Pose pose;             ///< input units
};

/// One step of the work. Poses are relative to the largest part that stays, whose pose is the assembled one. Directions
/// are thus those of the assembly, wherever a sub-assembly had been moved before it was disassembled.
struct BookStep {
  std::size_t number = 0;            ///< of the step in the mode of the book, as in step_numbers.h
  std::size_t plan_step = 0;         ///< index into Plan::disassembly
  std::vector<PlacedPart> standing;  ///< the parts that do not move
  std::vector<BookMover> movers;
  std::optional<Eigen::Vector3d> up{};  ///< unit; of the assembly while it lies for this step; none: as drawn
  std::vector<DrawnTool> tools{};       ///< on what is put in, at the end of the assembly operation
  bool shifts_only = false;             ///< no part joins or leaves: the parts only move aside
  std::vector<std::size_t> joined{};    ///< equal steps of the plan that follow and share the page; a mover for each
};

struct BookChapter {
  std::vector<std::size_t> parts;  ///< ascending
  std::vector<std::size_t> base;   ///< those of `parts` that are never taken out
  std::vector<BookStep> steps;     ///< not empty
  int letter = -1;  ///< number of the sub-assembly in the order of the first steps, from 0; -1: the whole assembly
};

/// For assembly, the chapter of a sub-assembly precedes that of the group that it joins; for disassembly, it follows.
/// Within a chapter, steps are in the order of the plan (disassembly) or in reverse order (assembly).
/// @throws InputError when the plan names a part that the assembly does not have, or a step takes parts from two
/// groups.
std::vector<BookChapter> instructions(const Plan& plan, const Assembly& assembly, bool disassembly);

}  // namespace dismantle
