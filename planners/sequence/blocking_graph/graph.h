/// The directional blocking graph: which groups can move together along a direction.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace dismantle::blocking {

/// A node that blocks `node` and is not `inside`; nullopt: there is none.
using BlockerOutside =
    std::function<std::optional<std::size_t>(std::size_t node, const std::function<bool(std::size_t)>& inside)>;

/// The smallest groups that can move: strongly connected components of the graph that no node outside blocks (Wilson
/// and Latombe 1994), each ascending, in the order of their first nodes. Empty when all nodes are one component, since
/// then only all of them together can move. Edges are asked for as they are needed: a node that is blocked mostly needs
/// one, so that most relations of an assembly are never computed.
std::vector<std::vector<std::size_t>> free_groups(std::size_t nodes, const BlockerOutside& blocker_outside);

}  // namespace dismantle::blocking
