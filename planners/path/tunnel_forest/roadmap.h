/// Nodes, edges and trees of a forest.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "dismantle/geometry/numerics.h"
#include "dismantle/path_planner.h"

namespace dismantle::tunnel_forest {

/// A forest whose trees grow, join and split. Edges have no direction.
class Roadmap {
 public:
  using Index = std::uint32_t;

  struct Node {
    State state;
    Eigen::Vector3d center;   ///< of the first moving part, world
    Eigen::Quaterniond turn;  ///< of the first moving part since the start, world
    Index tree = geometry::kNoIndex;
    Index expansions = 0;
    bool separated = false;
    std::vector<Index> edges{};
    std::uint64_t cell = 0;
  };
  struct Edge {
    Index a = geometry::kNoIndex, b = geometry::kNoIndex;
    Path path;  ///< from a to b: a's poses excluded, b's included
    bool cut = false;
  };
  struct Tree {
    std::vector<Index> nodes;
    std::uint32_t separated = 0;  ///< number of its nodes that are separated
  };

  /// `cell`: edge of the cells in which density() counts nodes (assembly units). `arm`: length equivalent to a
  /// rotation of 1 rad.
  Roadmap(double cell, double arm) : cell_(cell), arm_(arm) {}

  /// Adds a tree with one node.
  Index add_tree(Node node);
  /// Adds a node to the tree of `from`. `path` ends with the node's poses.
  Index grow(Index from, Node node, Path path);
  /// Joins the two different trees of a and b. `path` leads from a to b.
  void join(Index a, Index b, Path path);
  /// Removes an edge and splits its tree in two.
  void cut(Index edge);

  Node& node(Index i) { return nodes_[i]; }
  const Node& node(Index i) const { return nodes_[i]; }
  std::size_t size() const { return nodes_.size(); }
  const Tree& tree(Index t) const { return trees_[t]; }
  /// Trees that have nodes, oldest first.
  const std::vector<Index>& trees() const { return live_trees_; }
  /// Number of nodes in the cell of `node`.
  std::uint32_t density(Index node) const { return cells_.at(nodes_[node].cell); }
  std::size_t cells() const { return cells_.size(); }

  double distance(const Eigen::Vector3d& center, const Eigen::Quaterniond& turn, const Node& n) const;
  Index nearest(const Eigen::Vector3d& center, const Eigen::Quaterniond& turn, Index tree) const;

  /// Edges from `from` to the separated node with the fewest edges in between. Empty if the tree has no separated node,
  /// or if `from` is separated.
  std::vector<Index> edges_to_separated(Index from) const;
  /// The path along an edge from its end `from`, without the poses of `from`.
  Path along(Index edge, Index from) const;
  Index other_end(Index edge, Index from) const { return edges_[edge].a == from ? edges_[edge].b : edges_[edge].a; }

 private:
  Index add(Node node, Index tree);
  Index connect(Index a, Index b, Path path);
  void relabel(Index from, Index tree);

  double cell_, arm_;
  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
  std::vector<Tree> trees_;
  std::vector<Index> live_trees_;
  std::unordered_map<std::uint64_t, std::uint32_t> cells_;
};

}  // namespace dismantle::tunnel_forest
