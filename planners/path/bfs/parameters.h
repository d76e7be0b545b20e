/// Parameters of the bfs path planner.
#pragma once

#include "dismantle/push/parameters.h"

namespace dismantle::bfs {

struct Parameters : push::SearchParameters {
  static void describe(Schema<Parameters>& s) {
    push::describe_search(s);
    push::describe_effort(s);
  }

  push::Tactics tactics() const {
    push::Tactics t = push::tactics_of(*this);
    t.translating = {push::Stage::axes};
    t.turning = {push::Stage::axes};
    if (diagonals) push::add_diagonals(t);
    return t;
  }
};

}  // namespace dismantle::bfs
