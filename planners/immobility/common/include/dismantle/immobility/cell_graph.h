/// Cells that cover what can be reached, divided as needed: is the start cut off from the border?
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

namespace dismantle::immobility {

/// A cell, with respect to the whole.
struct CellPlace {
  double narrow = 0;       ///< ways to the border are looked for where the narrowest of their cells is least so, ...
  double from_border = 0;  ///< ... of equals, where this is least
  bool border = false;     ///< it touches the border
  bool start = false;      ///< it holds the start
};

/// A Cell has `bool empty` (nothing in it can be reached) and `bool touches(const Cell&)`. Cells that touch and are not
/// empty are neighbours. What was found of the search from the start is kept while cells are divided.
template <class Cell>
class CellGraph {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  CellGraph(Cell all, const CellPlace& place) {
    nodes_.emplace_back(std::move(all), place);
    if (place.start) reach(0, kNone);
  }

  std::size_t size() const { return nodes_.size(); }
  const Cell& operator[](std::uint32_t node) const { return nodes_[node].cell; }
  Cell& operator[](std::uint32_t node) { return nodes_[node].cell; }
  /// From where the node was reached; kNone for the start.
  std::uint32_t from(std::uint32_t node) const { return nodes_[node].from; }
  /// After next_exit() returned kNone: can it be reached?
  bool connected(std::uint32_t node) const { return !nodes_[node].divided && nodes_[node].reached; }
  const CellPlace& place(std::uint32_t node) const { return nodes_[node].place; }
  bool divided(std::uint32_t node) const { return nodes_[node].divided; }
  void set_narrow(std::uint32_t node, double narrow) { nodes_[node].place.narrow = narrow; }
  /// The whole has changed. What is waiting to be gone on from keeps its turn.
  void set_place(std::uint32_t node, const CellPlace& place) { nodes_[node].place = place; }
  bool holds_start(std::uint32_t node) const { return nodes_[node].place.start; }

  /// Goes on from cell to cell, the closest to the border first, until one is there; kNone if none is.
  std::uint32_t next_exit() {
    while (!queue_.empty()) {
      const Entry e = queue_.top();
      Node& n = nodes_[e.node];
      if (n.divided || !n.reached || n.stamp != e.stamp) {
        queue_.pop();
        continue;
      }
      if (n.place.border) return e.node;
      queue_.pop();
      n.expanded = true;
      for (const std::uint32_t k : n.near)
        if (!nodes_[k].reached) reach(k, e.node);
    }
    return kNone;
  }

  /// One more, beside those that there are.
  void add(Cell cell, const CellPlace& place) {
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back(std::move(cell), place);
    for (std::uint32_t k = 0; k < node; ++k)
      if (!nodes_[k].divided) befriend(k, node);
    if (!nodes_[node].cell.empty) adopt(node);
  }

  /// Puts two in the place of one. Returns the first of them; the other follows.
  std::uint32_t divide(std::uint32_t node, std::pair<Cell, CellPlace> first_half,
                       std::pair<Cell, CellPlace> second_half) {
    const std::uint32_t from = nodes_[node].from;
    std::vector<std::uint32_t> lost, stack = nodes_[node].on;
    while (!stack.empty()) {
      const std::uint32_t k = stack.back();
      stack.pop_back();
      nodes_[k].reached = false;
      lost.push_back(k);
      stack.insert(stack.end(), nodes_[k].on.begin(), nodes_[k].on.end());
      nodes_[k].on.clear();
    }
    if (from != kNone) std::erase(nodes_[from].on, node);
    nodes_[node].reached = false;
    nodes_[node].on.clear();
    nodes_[node].divided = true;
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back(std::move(first_half.first), first_half.second);
    nodes_.emplace_back(std::move(second_half.first), second_half.second);
    join(node, first);
    for (const std::uint32_t k : {first, first + 1}) {
      if (nodes_[k].cell.empty) continue;
      if (from == kNone && nodes_[k].place.start && !any_start(first, k))
        reach(k, kNone);
      else
        adopt(k);
    }
    for (const std::uint32_t k : lost)
      if (!nodes_[k].reached) adopt(k);
    return first;
  }

 private:
  /// What the search from the start knows of a cell.
  struct Node {
    Cell cell;
    CellPlace place;
    bool divided = false, reached = false, expanded = false;
    double narrow = 0;  ///< of the way here
    std::uint32_t from = kNone, stamp = 0;
    std::vector<std::uint32_t> on, near;  ///< reached from here; neighbours

    Node(Cell c, const CellPlace& p) : cell(std::move(c)), place(p) {}
  };
  struct Entry {
    double narrow, from_border;
    std::uint32_t node, stamp;
    bool operator<(const Entry& o) const {
      return std::tie(narrow, from_border, node) > std::tie(o.narrow, o.from_border, o.node);
    }
  };

  /// Is the first of two halves, before `k`, where the search starts?
  bool any_start(std::uint32_t first, std::uint32_t k) const {
    return k != first && nodes_[first].reached && nodes_[first].from == kNone;
  }

  void reach(std::uint32_t node, std::uint32_t from) {
    Node& n = nodes_[node];
    n.reached = true;
    n.expanded = false;
    n.from = from;
    ++n.stamp;
    n.on.clear();
    if (from != kNone) nodes_[from].on.push_back(node);
    n.narrow = n.place.narrow;
    if (from != kNone) n.narrow = std::max(n.narrow, nodes_[from].narrow);
    queue_.push({n.narrow, n.place.from_border, node, n.stamp});
  }

  /// Reaches a cell again from a neighbour, if one is.
  void adopt(std::uint32_t node) {
    const auto& near = nodes_[node].near;
    const auto by = std::find_if(near.begin(), near.end(),
                                 [&](std::uint32_t k) { return nodes_[k].reached && nodes_[k].expanded; });
    if (by != near.end()) reach(node, *by);
  }

  void befriend(std::uint32_t x, std::uint32_t y) {
    if (nodes_[x].cell.empty || nodes_[y].cell.empty || !nodes_[x].cell.touches(nodes_[y].cell)) return;
    nodes_[x].near.push_back(y);
    nodes_[y].near.push_back(x);
  }

  /// The halves take the place of the whole among its neighbours.
  void join(std::uint32_t node, std::uint32_t first) {
    for (const std::uint32_t k : nodes_[node].near) {
      auto& near = nodes_[k].near;
      near.erase(std::find(near.begin(), near.end(), node));
      befriend(first, k);
      befriend(first + 1, k);
    }
    befriend(first, first + 1);
    std::vector<std::uint32_t>().swap(nodes_[node].near);
  }

  std::vector<Node> nodes_;
  std::priority_queue<Entry> queue_;
};

}  // namespace dismantle::immobility
