/// The plan's steps laid out in time: the pose of each part at each time.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/pose.h"

namespace dismantle {

struct Key {
  float time = 0;  ///< s
  Pose pose;       ///< input units; quaternions of consecutive keys lie on one hemisphere
};

struct Track {
  PartId part = 0;
  std::vector<Key> keys;  ///< times strictly increase
};

struct StepTime {
  std::size_t index = 0;     ///< among the steps of the plan
  unsigned step = 0;         ///< its number
  float begin = 0, end = 0;  ///< s, of the first and of the last pose
  std::vector<PartId> parts;
  std::vector<float> pose_times;  ///< s, one per pose of the step's moves; strictly increase
};

struct Timeline {
  std::vector<Track> tracks;
  std::vector<StepTime> steps;  ///< those that move something
  float duration = 0;           ///< s; 0 when nothing moves
};

/// How the assembly lies in each step of an animation, in its order: the direction (unit) that points upwards. None: as
/// drawn.
using StepUps = std::vector<std::optional<Eigen::Vector3d>>;

/// Of the disassembly.
StepUps disassembly_ups(const Plan& plan);
/// Of the assembly: a step that does not say it lies like the disassembly step that it reverses.
StepUps assembly_ups(const Plan& plan);

/// One track per part that moves, in part order. Steps follow each other with short pauses, and with longer ones where
/// the assembly has to be turned; within a step the fastest
/// part moves at constant speed, and the step takes 1 to 3 s, depending on its travel. Every track ends at the same
/// time, 1 s after the last motion, so that a looping viewer rests on the result. Before its first key, a part is at
/// that key.
/// @throws InputError when the plan names a part that the assembly does not have.
Timeline timeline(const std::vector<PlanStep>& steps, const Assembly& assembly, const StepUps& ups);

}  // namespace dismantle
