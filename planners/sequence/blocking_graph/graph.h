/// The directional blocking graph: which groups can move together along a direction.
#pragma once

#include <cstddef>
#include <vector>

namespace dismantle::blocking {

/// `in_way[i]`: what i would run into. Strongly connected components, each ascending; one without edges to others comes
/// before those that have edges to it (Tarjan 1972).
std::vector<std::vector<std::size_t>> strong_components(const std::vector<std::vector<std::size_t>>& in_way);

/// The smallest groups that can move: components that nothing outside them blocks. Nothing when all nodes are one
/// component: then only everything together can move.
std::vector<std::vector<std::size_t>> free_groups(const std::vector<std::vector<std::size_t>>& in_way);

}  // namespace dismantle::blocking
