/// Nodes and ways of a forest: which trees there are, and what leads from the start to a node.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle::tunnel_forest {

/// A forest whose trees may grow, join, and fall apart. Ways have no direction.
class Roadmap {
 public:
  using Index = std::uint32_t;
  static constexpr Index kNone = 0xffffffffu;

  struct Node {
    State state;
    Eigen::Vector3d center;   ///< of the first moving part, world
    Eigen::Quaterniond turn;  ///< likewise, since the start
    Index tree = kNone;
    Index expansions = 0;
    bool out = false;
    std::vector<Index> edges{};
    std::uint64_t cell = 0;
  };
  struct Edge {
    Index a = kNone, b = kNone;
    Path way;  ///< from a to b: a's poses excluded, b's included
    bool cut = false;
  };
  struct Tree {
    std::vector<Index> nodes;
    std::uint32_t out = 0;  ///< nodes that are out
  };

  /// `spacing`: edge of the cells that crowd() counts in (assembly units); `arm`: what turns are multiplied by.
  Roadmap(double spacing, double arm) : spacing_(spacing), arm_(arm) {}

  /// A tree of its own.
  Index plant(Node node);
  /// In the tree of `from`. `way` ends with the node's poses.
  Index grow(Index from, Node node, Path way);
  /// Joins the trees of a and b, which are two. `way` from a to b.
  void join(Index a, Index b, Path way);
  /// The tree that it was in falls apart.
  void cut(Index edge);

  Node& node(Index i) { return nodes_[i]; }
  const Node& node(Index i) const { return nodes_[i]; }
  std::size_t size() const { return nodes_.size(); }
  const Tree& tree(Index t) const { return trees_[t]; }
  /// Trees with nodes, oldest first.
  const std::vector<Index>& trees() const { return living_; }
  /// Nodes about where this one is.
  std::uint32_t crowd(Index node) const { return cells_.at(nodes_[node].cell); }
  std::size_t cells() const { return cells_.size(); }

  double distance(const Eigen::Vector3d& center, const Eigen::Quaterniond& turn, const Node& n) const;
  Index nearest(const Eigen::Vector3d& center, const Eigen::Quaterniond& turn, Index tree) const;

  /// Edges from `from` to the nearest node (by edges) that is out; empty when its tree has none, or when it is `from`.
  std::vector<Index> way_out(Index from) const;
  /// The way along an edge that begins at `from`: `from`'s poses excluded.
  Path along(Index edge, Index from) const;
  Index other_end(Index edge, Index from) const { return edges_[edge].a == from ? edges_[edge].b : edges_[edge].a; }

 private:
  Index add(Node node, Index tree);
  Index connect(Index a, Index b, Path way);
  void relabel(Index from, Index tree);

  double spacing_, arm_;
  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
  std::vector<Tree> trees_;
  std::vector<Index> living_;
  std::unordered_map<std::uint64_t, std::uint32_t> cells_;
};

}  // namespace dismantle::tunnel_forest
