/// The middle of a bar as a graph of nodes, and the holes that it goes through.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/section.h"
#include "hook/hook_cage.h"

namespace dismantle::immobility {

/// A point in the middle of the bar and what it keeps.
struct Node {
  Eigen::Vector3d at;
  double keep;
};

/// Nodes for a depth, thinned out: the deepest first, others only at some distance.
std::vector<Node> nodes_of(const std::vector<InnerBall>& balls, double depth);

/// Share of what two nodes keep: nodes nearer to each other than that are joined.
inline constexpr double kJoined = 0.95;
/// By node: the nodes that it is joined with.
using Joined = std::vector<std::vector<std::size_t>>;
Joined join(const std::vector<Node>& nodes);

/// Curves on the surface close around the bar, one for each hole, in the middle of it; with the node there.
std::vector<std::pair<Loop, std::size_t>> holes(const Surface& surface, const Solid& around,
                                                const std::vector<Node>& nodes, std::size_t most);

}  // namespace dismantle::immobility
