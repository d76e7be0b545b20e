/// Parameters of the bfs path planner.
#pragma once

#include "dismantle/push/parameters.h"

namespace dismantle::bfs {

struct Parameters {
  push::Motion motion = push::Motion::automatic;
  // Table 6.
  double time_step = 0.1;
  double force = 100;
  double similarity_translation = 0.05;
  double similarity_rotation = 0.5;
  // Where we go beyond Algorithm 1; see README.md.
  bool diagonals = true;
  std::int64_t intermediate = 256;
  double thinning = 1e-4;
  std::int64_t max_refusals = 8;
  std::int64_t translation_nodes = 24;
  std::int64_t rotation_nodes = 8;

  static void describe(Schema<Parameters>& s) {
    push::describe_search(s);
    push::describe_effort(s);
  }

  push::Tactics tactics() const {
    push::Tactics t = push::tactics_of(*this);
    t.translating = {push::Stage::axes};
    t.turning = {push::Stage::axes};
    if (diagonals) {
      t.translating.push_back(push::Stage::diagonals);
      t.turning.push_back(push::Stage::screws);
    }
    return t;
  }
};

}  // namespace dismantle::bfs
