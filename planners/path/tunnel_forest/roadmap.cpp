#include "roadmap.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "dismantle/path/placed_parts.h"

namespace dismantle::tunnel_forest {

double Roadmap::distance(const Eigen::Vector3d& center, const Eigen::Quaterniond& turn, const Node& n) const {
  return (center - n.center).norm() + (arm_ > 0 ? arm_ * angle_between(turn, n.turn) : 0.0);
}

Roadmap::Index Roadmap::nearest(const Eigen::Vector3d& center, const Eigen::Quaterniond& turn, Index tree) const {
  Index best = kNone;
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
  std::uint64_t cell = 0xcbf29ce484222325u;  // FNV-1a over the six coordinates
  for (const Eigen::Vector3d& v : {node.center, turn})
    for (int k = 0; k < 3; ++k) {
      cell ^= static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v[k] / spacing_)));
      cell *= 0x100000001b3u;
    }
  node.cell = cell;
  node.tree = tree;
  ++cells_[cell];
  nodes_.push_back(std::move(node));
  const auto id = static_cast<Index>(nodes_.size() - 1);
  trees_[tree].nodes.push_back(id);
  if (nodes_[id].out) ++trees_[tree].out;
  return id;
}

Roadmap::Index Roadmap::plant(Node node) {
  trees_.emplace_back();
  living_.push_back(static_cast<Index>(trees_.size() - 1));
  return add(std::move(node), living_.back());
}

Roadmap::Index Roadmap::connect(Index a, Index b, Path way) {
  edges_.push_back({a, b, std::move(way)});
  const auto id = static_cast<Index>(edges_.size() - 1);
  nodes_[a].edges.push_back(id);
  nodes_[b].edges.push_back(id);
  return id;
}

Roadmap::Index Roadmap::grow(Index from, Node node, Path way) {
  const Index id = add(std::move(node), nodes_[from].tree);
  connect(from, id, std::move(way));
  return id;
}

void Roadmap::join(Index a, Index b, Path way) {
  const Index keep = std::min(nodes_[a].tree, nodes_[b].tree), drop = std::max(nodes_[a].tree, nodes_[b].tree);
  connect(a, b, std::move(way));
  Tree& to = trees_[keep];
  Tree& from = trees_[drop];
  for (const Index n : from.nodes) nodes_[n].tree = keep;
  to.nodes.insert(to.nodes.end(), from.nodes.begin(), from.nodes.end());
  to.out += from.out;
  from = {};
  std::erase(living_, drop);
}

void Roadmap::relabel(Index from, Index tree) {
  std::deque<Index> waiting{from};
  nodes_[from].tree = tree;
  while (!waiting.empty()) {
    const Index n = waiting.front();
    waiting.pop_front();
    trees_[tree].nodes.push_back(n);
    if (nodes_[n].out) ++trees_[tree].out;
    for (const Index e : nodes_[n].edges) {
      const Index m = other_end(e, n);
      if (edges_[e].cut || nodes_[m].tree == tree) continue;
      nodes_[m].tree = tree;
      waiting.push_back(m);
    }
  }
}

void Roadmap::cut(Index edge) {
  if (edges_[edge].cut) return;
  edges_[edge].cut = true;
  const Index a = edges_[edge].a, b = edges_[edge].b, old = nodes_[a].tree;
  // What holds the oldest node keeps its name.
  const Index oldest = *std::min_element(trees_[old].nodes.begin(), trees_[old].nodes.end());
  for (const Index n : trees_[old].nodes) nodes_[n].tree = kNone;
  trees_[old] = {};
  relabel(oldest, old);
  trees_.emplace_back();
  living_.push_back(static_cast<Index>(trees_.size() - 1));
  relabel(nodes_[a].tree == kNone ? a : b, living_.back());
}

std::vector<Roadmap::Index> Roadmap::way_out(Index from) const {
  std::vector<Index> back(nodes_.size(), kNone);  // edge that a node was reached by
  std::vector<bool> seen(nodes_.size(), false);
  std::deque<Index> waiting{from};
  seen[from] = true;
  while (!waiting.empty()) {
    Index n = waiting.front();
    waiting.pop_front();
    if (nodes_[n].out) {
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
      waiting.push_back(m);
    }
  }
  return {};
}

Path Roadmap::along(Index edge, Index from) const {
  const Edge& e = edges_[edge];
  if (e.a == from) return e.way;
  Path way(e.way.rbegin() + 1, e.way.rend());
  way.push_back(path::poses_of(nodes_[e.a].state));
  return way;
}

}  // namespace dismantle::tunnel_forest
