/// The directional blocking graph: which groups can move together along a direction.
#pragma once

#include <cstddef>
#include <vector>

namespace dismantle::blocking {

/// `in_way[i]`: the nodes that block i. Strongly connected components, each ascending, in reverse topological order
/// (Tarjan 1972).
std::vector<std::vector<std::size_t>> strong_components(const std::vector<std::vector<std::size_t>>& in_way);

/// The smallest groups that can move: components that no node outside blocks. Empty when all nodes are one component,
/// since then only all of them together can move.
std::vector<std::vector<std::size_t>> free_groups(const std::vector<std::vector<std::size_t>>& in_way);

}  // namespace dismantle::blocking
