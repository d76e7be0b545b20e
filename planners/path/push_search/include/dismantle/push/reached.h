/// What a search over pushes has reached, for one that resumes it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "dismantle/path/resume.h"
#include "dismantle/path_planner.h"

namespace dismantle::push {

/// A state of the search tree, and how it is reached.
struct Node {
  State state;
  std::int32_t parent = -1;
  unsigned depth = 0;             ///< actions from the start
  Path way{};                     ///< instants after the parent's, this one's last
  std::size_t stage = 0;          ///< the next to come
  bool middle = false;            ///< of a run
  bool may_wait = false;          ///< may be expanded; otherwise it is only a known state
  std::vector<PartId> touched{};  ///< fixed parts that ended runs there; ascending
  std::uint64_t work = 0;         ///< simulated steps and state checks of the runs from it
};

/// A state in the middle of a run that is no node yet.
struct Middle {
  std::int32_t from;
  unsigned depth;
  State state;
  Path way;
};

/// Of a search in one motion space.
struct Tree {
  std::vector<PartId> fixed;  ///< ascending
  std::vector<Node> nodes;    ///< parents before their children
  std::vector<Middle> passed;
  std::size_t passed_before = 0;  ///< states in the middle of runs that became nodes, or were dropped
  bool relaxed = false;           ///< World::allow_overlap_everywhere
  std::vector<path::ContactSample> samples;
  bool short_glides = false;
};

class Reached final : public SearchState {
 public:
  std::optional<Tree> translation, rigid;  ///< absent: nothing was searched there
};

}  // namespace dismantle::push
