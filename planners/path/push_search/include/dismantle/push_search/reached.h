/// Search trees of a push search, kept so that a later search can resume from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "dismantle/path/resume.h"
#include "dismantle/path_planner.h"

namespace dismantle::push {

/// A state of the search tree, and the motion from its parent.
struct Node {
  State state;
  std::int32_t parent = -1;
  unsigned depth = 0;             ///< actions from the start
  Path motion{};                  ///< instants after the parent's, up to its own
  std::size_t stage = 0;          ///< the next one to be applied
  bool middle = false;            ///< in the middle of a run, not at its end
  bool may_wait = false;          ///< may be expanded; otherwise only compared with new states
  std::vector<PartId> touched{};  ///< fixed parts touched where runs ended in this state; ascending
  std::uint64_t work = 0;         ///< simulated steps and state checks of the runs that began here
};

/// A state in the middle of a run that is not a node yet.
struct Middle {
  std::int32_t from;
  unsigned depth;
  State state;
  Path motion;
};

/// The search tree of one motion space.
struct Tree {
  std::vector<PartId> fixed;  ///< ascending
  std::vector<Node> nodes;    ///< parents before their children
  std::vector<Middle> middles;
  std::size_t middles_before = 0;  ///< states in the middle of runs that became nodes, or were dropped
  bool relaxed = false;            ///< World::allow_overlap_everywhere
  std::vector<path::ContactSample> samples;
  bool short_glides = false;
};

class Reached final : public SearchState {
 public:
  std::optional<Tree> translation, rigid;  ///< absent: this motion space was not searched
};

}  // namespace dismantle::push
