/// The plan's steps laid out in time: the pose of each part at each time.
#pragma once

#include <Eigen/Core>
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

/// One track per part that moves, in part order. Steps follow each other with short pauses; within a step the fastest
/// part moves at constant speed, and the step takes 1 to 3 s, depending on its travel. Every track ends at the same
/// time, 1 s after the last motion, so that a looping viewer rests on the result. Before its first key, a part is at
/// that key.
/// @throws InputError when the plan names a part that the assembly does not have.
Timeline timeline(const std::vector<PlanStep>& steps, const Assembly& assembly);

}  // namespace dismantle
