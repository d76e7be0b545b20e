#include "roadmap.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "dismantle/search/placed_parts.h"

namespace dismantle::tunnel_forest {

double Roadmap::distance(const Eigen::Vector3d& center, const Eigen::Quaterniond& turn, const Node& n) const {
  return (center - n.center).norm() + (arm_ > 0 ? arm_ * angle_between(turn, n.turn) : 0.0);
}

Roadmap::Index Roadmap::nearest(const Eigen::Vector3d& center, const Eigen::Quaterniond& turn, Index tree) const {
  Index best = geometry::kNoIndex;
  double least = std::numeric_limits<double>::infinity();
  for (const Index n : trees_[tree].nodes) {
    const Node& node = nodes_[n];
    if ((center - node.center).squaredNorm() >= least * least) continue;
    const double d = distance(center, turn, node);
    if (d < least) least = d, best = n;
  }
  return best;
}

Roadmap::Index Roadmap::add(Node node, Index tree) {
  const Eigen::Vector3d turn = arm_ > 0 ? Eigen::Vector3d(arm_ * rotation_vector(node.turn)) : Eigen::Vector3d::Zero();
  std::uint64_t cell = 0xcbf29ce484222325u;  // FNV-1a hash of the six coordinates
  for (const Eigen::Vector3d& v : {node.center, turn})
    for (int k = 0; k < 3; ++k) {
      cell ^= static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v[k] / cell_)));
      cell *= 0x100000001b3u;
    }
  node.cell = cell;
  node.tree = tree;
  ++cells_[cell];
  nodes_.push_back(std::move(node));
  const auto id = static_cast<Index>(nodes_.size() - 1);
  trees_[tree].nodes.push_back(id);
  if (nodes_[id].separated) ++trees_[tree].separated;
  return id;
}

Roadmap::Index Roadmap::add_tree(Node node) {
  trees_.emplace_back();
  live_trees_.push_back(static_cast<Index>(trees_.size() - 1));
  return add(std::move(node), live_trees_.back());
}

Roadmap::Index Roadmap::connect(Index a, Index b, Path path) {
  edges_.push_back({a, b, std::move(path)});
  const auto id = static_cast<Index>(edges_.size() - 1);
  nodes_[a].edges.push_back(id);
  nodes_[b].edges.push_back(id);
  return id;
}

Roadmap::Index Roadmap::grow(Index from, Node node, Path path) {
  const Index id = add(std::move(node), nodes_[from].tree);
  connect(from, id, std::move(path));
  return id;
}

void Roadmap::join(Index a, Index b, Path path) {
  const Index keep = std::min(nodes_[a].tree, nodes_[b].tree), drop = std::max(nodes_[a].tree, nodes_[b].tree);
  connect(a, b, std::move(path));
  Tree& to = trees_[keep];
  Tree& from = trees_[drop];
  for (const Index n : from.nodes) nodes_[n].tree = keep;
  to.nodes.insert(to.nodes.end(), from.nodes.begin(), from.nodes.end());
  to.separated += from.separated;
  from = {};
  std::erase(live_trees_, drop);
}

void Roadmap::relabel(Index from, Index tree) {
  std::deque<Index> queue{from};
  nodes_[from].tree = tree;
  while (!queue.empty()) {
    const Index n = queue.front();
    queue.pop_front();
    trees_[tree].nodes.push_back(n);
    if (nodes_[n].separated) ++trees_[tree].separated;
    for (const Index e : nodes_[n].edges) {
      const Index m = other_end(e, n);
      if (edges_[e].cut || nodes_[m].tree == tree) continue;
      nodes_[m].tree = tree;
      queue.push_back(m);
    }
  }
}

void Roadmap::cut(Index edge) {
  if (edges_[edge].cut) return;
  edges_[edge].cut = true;
  const Index a = edges_[edge].a, b = edges_[edge].b, old = nodes_[a].tree;
  // The piece with the oldest node keeps the index of the tree.
  const Index oldest = *std::min_element(trees_[old].nodes.begin(), trees_[old].nodes.end());
  for (const Index n : trees_[old].nodes) nodes_[n].tree = geometry::kNoIndex;
  trees_[old] = {};
  relabel(oldest, old);
  trees_.emplace_back();
  live_trees_.push_back(static_cast<Index>(trees_.size() - 1));
  relabel(nodes_[a].tree == geometry::kNoIndex ? a : b, live_trees_.back());
}

std::vector<Roadmap::Index> Roadmap::edges_to_separated(Index from) const {
  std::vector<Index> back(nodes_.size(), geometry::kNoIndex);  // by node: the edge through which it was reached
  std::vector<bool> seen(nodes_.size(), false);
  std::deque<Index> queue{from};
  seen[from] = true;
  while (!queue.empty()) {
    Index n = queue.front();
    queue.pop_front();
    if (nodes_[n].separated) {
      std::vector<Index> edges;
      for (; n != from; n = other_end(back[n], n)) edges.push_back(back[n]);
      std::reverse(edges.begin(), edges.end());
      return edges;
    }
    for (const Index e : nodes_[n].edges) {
      const Index m = other_end(e, n);
      if (edges_[e].cut || seen[m]) continue;
      seen[m] = true;
      back[m] = e;
      queue.push_back(m);
    }
  }
  return {};
}

Path Roadmap::along(Index edge, Index from) const {
  const Edge& e = edges_[edge];
  if (e.a == from) return e.path;
  Path reversed(e.path.rbegin() + 1, e.path.rend());
  reversed.push_back(path::poses_of(nodes_[e.a].state));
  return reversed;
}

}  // namespace dismantle::tunnel_forest
