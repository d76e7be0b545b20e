/// An adaptive cell decomposition with an incremental search from the start cell to the border.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "dismantle/geometry/numerics.h"
#include "dismantle/immobility/geometry_names.h"

namespace dismantle::immobility {

/// Where a cell is in the decomposed region, and its cost.
struct CellStatus {
  double cost = 0;             ///< the search minimizes the largest cost along a path (bottleneck path)
  double border_distance = 0;  ///< breaks ties: the search prefers cells close to the border
  bool on_border = false;
  bool has_start = false;
};

/// A Cell has `bool empty` (no point of it can be reached) and `bool touches(const Cell&)`. Two cells that touch and
/// are not empty are neighbours. The search tree is repaired, not rebuilt, when a cell is divided.
template <class Cell>
class CellGraph {
 public:
  CellGraph(Cell all, const CellStatus& status) {
    nodes_.emplace_back(std::move(all), status);
    if (status.has_start) attach(0, kNoIndex);
  }

  std::size_t size() const { return nodes_.size(); }
  /// Number of nodes and links that divisions have touched: a division near the start repairs most of the tree.
  std::uint64_t work() const { return work_; }
  const Cell& operator[](std::uint32_t node) const { return nodes_[node].cell; }
  Cell& operator[](std::uint32_t node) { return nodes_[node].cell; }
  /// The cell from which this one was reached; kNoIndex for the start.
  std::uint32_t parent(std::uint32_t node) const { return nodes_[node].parent; }
  /// After next_exit() returned kNoIndex: is the cell in the component of the start?
  bool reachable(std::uint32_t node) const { return !nodes_[node].divided && nodes_[node].reached; }
  const CellStatus& status(std::uint32_t node) const { return nodes_[node].status; }
  bool divided(std::uint32_t node) const { return nodes_[node].divided; }
  void set_cost(std::uint32_t node, double cost) { nodes_[node].status.cost = cost; }
  /// For use when the decomposed region has grown. Does not change the order of cells that wait to be expanded.
  void set_status(std::uint32_t node, const CellStatus& status) { nodes_[node].status = status; }
  bool has_start(std::uint32_t node) const { return nodes_[node].status.has_start; }

  /// Expands cells in the order of the search until one on the border is reached. Returns it; kNoIndex if there is
  /// none.
  std::uint32_t next_exit() {
    while (!queue_.empty()) {
      const Entry e = queue_.top();
      Node& n = nodes_[e.node];
      if (n.divided || !n.reached || n.stamp != e.stamp) {
        queue_.pop();
        continue;
      }
      if (n.status.on_border) return e.node;
      queue_.pop();
      n.expanded = true;
      for (const std::uint32_t k : n.neighbours)
        if (!nodes_[k].reached) attach(k, e.node);
    }
    return kNoIndex;
  }

  /// Adds a cell beside the existing ones.
  void add(Cell cell, const CellStatus& status) {
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back(std::move(cell), status);
    for (std::uint32_t k = 0; k < node; ++k)
      if (!nodes_[k].divided) link(k, node);
    if (!nodes_[node].cell.empty) reattach(node);
  }

  /// Replaces a cell by two. Returns the index of the first; the second follows it.
  std::uint32_t divide(std::uint32_t node, std::pair<Cell, CellStatus> first_half,
                       std::pair<Cell, CellStatus> second_half) {
    const std::uint32_t parent = nodes_[node].parent;
    std::vector<std::uint32_t> lost, stack = nodes_[node].children;
    while (!stack.empty()) {
      const std::uint32_t k = stack.back();
      stack.pop_back();
      nodes_[k].reached = false;
      lost.push_back(k);
      stack.insert(stack.end(), nodes_[k].children.begin(), nodes_[k].children.end());
      nodes_[k].children.clear();
    }
    if (parent != kNoIndex) std::erase(nodes_[parent].children, node);
    nodes_[node].reached = false;
    nodes_[node].children.clear();
    nodes_[node].divided = true;
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back(std::move(first_half.first), first_half.second);
    nodes_.emplace_back(std::move(second_half.first), second_half.second);
    link_halves(node, first);
    for (const std::uint32_t k : {first, first + 1}) {
      if (nodes_[k].cell.empty) continue;
      if (parent == kNoIndex && nodes_[k].status.has_start && !first_is_root(first, k))
        attach(k, kNoIndex);
      else
        reattach(k);
    }
    for (const std::uint32_t k : lost)
      if (!nodes_[k].reached) reattach(k);
    work_ += lost.size();
    return first;
  }

 private:
  struct Node {
    Cell cell;
    CellStatus status;
    bool divided = false, reached = false, expanded = false;
    double cost = 0;  ///< of the path from the start
    std::uint32_t parent = kNoIndex, stamp = 0;
    std::vector<std::uint32_t> children, neighbours;

    Node(Cell c, const CellStatus& s) : cell(std::move(c)), status(s) {}
  };
  struct Entry {
    double cost, border_distance;
    std::uint32_t node, stamp;
    bool operator<(const Entry& o) const {
      return std::tie(cost, border_distance, node) > std::tie(o.cost, o.border_distance, o.node);
    }
  };

  /// The start may lie on the common face of two halves. Then the first half is the root, not `k`.
  bool first_is_root(std::uint32_t first, std::uint32_t k) const {
    return k != first && nodes_[first].reached && nodes_[first].parent == kNoIndex;
  }

  void attach(std::uint32_t node, std::uint32_t parent) {
    Node& n = nodes_[node];
    n.reached = true;
    n.expanded = false;
    n.parent = parent;
    ++n.stamp;
    n.children.clear();
    if (parent != kNoIndex) nodes_[parent].children.push_back(node);
    n.cost = n.status.cost;
    if (parent != kNoIndex) n.cost = std::max(n.cost, nodes_[parent].cost);
    queue_.push({n.cost, n.status.border_distance, node, n.stamp});
  }

  /// Attaches a cell to a neighbour that was expanded already, if there is one.
  void reattach(std::uint32_t node) {
    const auto& near = nodes_[node].neighbours;
    const auto by = std::find_if(near.begin(), near.end(),
                                 [&](std::uint32_t k) { return nodes_[k].reached && nodes_[k].expanded; });
    work_ += static_cast<std::uint64_t>(by - near.begin());
    if (by != near.end()) attach(node, *by);
  }

  void link(std::uint32_t x, std::uint32_t y) {
    if (nodes_[x].cell.empty || nodes_[y].cell.empty || !nodes_[x].cell.touches(nodes_[y].cell)) return;
    nodes_[x].neighbours.push_back(y);
    nodes_[y].neighbours.push_back(x);
  }

  /// Links the halves of a divided cell to its neighbours and to each other.
  void link_halves(std::uint32_t node, std::uint32_t first) {
    for (const std::uint32_t k : nodes_[node].neighbours) {
      auto& near = nodes_[k].neighbours;
      near.erase(std::find(near.begin(), near.end(), node));
      link(first, k);
      link(first + 1, k);
    }
    link(first, first + 1);
    std::vector<std::uint32_t>().swap(nodes_[node].neighbours);
  }

  std::vector<Node> nodes_;
  std::priority_queue<Entry> queue_;
  std::uint64_t work_ = 0;
};

}  // namespace dismantle::immobility
