// Trees after random growth, joins and cuts, compared with a search over all edges.
#include "roadmap.h"

#include <gtest/gtest.h>

#include <set>

namespace dismantle::tunnel_forest {
namespace {

using Index = Roadmap::Index;

Roadmap::Node node_at(double x, bool separated) {
  Roadmap::Node n;
  n.state.bodies.resize(1);
  n.state.bodies[0].pose.t = Eigen::Vector3d(x, 0, 0);
  n.center = n.state.bodies[0].pose.t;
  n.turn = Eigen::Quaterniond::Identity();
  n.separated = separated;
  return n;
}

/// The expected roadmap: pairs of nodes with an edge.
struct Reference {
  std::size_t nodes = 0;
  std::vector<std::pair<Index, Index>> edges;
  std::vector<bool> cut;
  std::vector<Index> component() const {
    std::vector<Index> of(nodes);
    for (Index i = 0; i < nodes; ++i) of[i] = i;
    for (std::size_t round = 0; round < nodes; ++round)
      for (std::size_t e = 0; e < edges.size(); ++e)
        if (!cut[e]) of[edges[e].first] = of[edges[e].second] = std::min(of[edges[e].first], of[edges[e].second]);
    return of;
  }
};

void expect_same(const Roadmap& map, const Reference& reference) {
  const auto of = reference.component();
  std::set<Index> names;
  for (Index i = 0; i < reference.nodes; ++i) {
    names.insert(map.node(i).tree);
    for (Index j = 0; j < i; ++j) ASSERT_EQ(of[i] == of[j], map.node(i).tree == map.node(j).tree) << i << " " << j;
  }
  EXPECT_EQ(std::set<Index>(map.trees().begin(), map.trees().end()), names);
  std::size_t count = 0;
  for (const Index t : map.trees()) {
    std::uint32_t separated = 0;
    for (const Index n : map.tree(t).nodes) {
      EXPECT_EQ(map.node(n).tree, t);
      separated += map.node(n).separated ? 1 : 0;
    }
    EXPECT_EQ(map.tree(t).separated, separated);
    count += map.tree(t).nodes.size();
  }
  EXPECT_EQ(count, reference.nodes);
}

/// The edges start at node 0, are connected, and end at a separated node.
void expect_edges_to_separated(const Roadmap& map) {
  const std::vector<Index> edges = map.edges_to_separated(0);
  const bool none = map.tree(map.node(0).tree).separated == 0 || map.node(0).separated;
  EXPECT_EQ(edges.empty(), none);
  Index at = 0;
  for (const Index e : edges) {
    const Path path = map.along(e, at);
    const Index to = map.other_end(e, at);
    ASSERT_FALSE(path.empty());
    EXPECT_EQ(path.back()[0].t, map.node(to).center);
    const Path back = map.along(e, to);
    EXPECT_EQ(back.back()[0].t, map.node(at).center);
    EXPECT_EQ(back.size(), path.size());
    at = to;
  }
  if (!edges.empty()) {
    EXPECT_TRUE(map.node(at).separated);
  }
}

TEST(Roadmap, TreesAreTheConnectedComponents) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Rng rng(seed);
    Roadmap map(0.3, 1);
    Reference reference;
    map.add_tree(node_at(0, false));
    reference.nodes = 1;
    for (int k = 0; k < 60; ++k) {
      const auto any = [&] { return static_cast<Index>(rng.below(reference.nodes)); };
      const double x = 0.1 * static_cast<double>(reference.nodes);
      const bool separated = rng.below(12) == 0;
      const auto link = [&](Index a, Index b) {
        reference.edges.emplace_back(a, b);
        reference.cut.push_back(false);
      };
      const auto middle = [&](Index a, double to) {
        Pose half;
        half.t.x() = 0.5 * (map.node(a).center.x() + to);
        return half;
      };
      switch (rng.below(5)) {
        case 0:
          EXPECT_EQ(map.add_tree(node_at(x, separated)), reference.nodes++);
          break;
        case 1:
        case 2: {
          const Index from = any();
          Pose end;
          end.t.x() = x;
          EXPECT_EQ(map.grow(from, node_at(x, separated), {{middle(from, x)}, {end}}), reference.nodes);
          link(from, static_cast<Index>(reference.nodes++));
          break;
        }
        case 3: {
          const Index a = any(), b = any();
          if (map.node(a).tree == map.node(b).tree) break;
          map.join(a, b, {{map.node(b).state.bodies[0].pose}});
          link(a, b);
          break;
        }
        default:
          if (reference.edges.empty()) break;
          const auto e = static_cast<Index>(rng.below(reference.edges.size()));
          map.cut(e);
          map.cut(e);  // a second cut has no effect
          reference.cut[e] = true;
      }
      expect_same(map, reference);
      expect_edges_to_separated(map);
    }
  }
}

TEST(Roadmap, NearestIsTheNearestOfItsTree) {
  Rng rng(7);
  Roadmap map(0.3, 0.7);
  const auto random_node = [&] {
    Roadmap::Node n = node_at(0, false);
    n.center = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
    n.turn = rotation_from_vector(Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()));
    return n;
  };
  const Index a = map.add_tree(random_node()), b = map.add_tree(random_node());
  for (int k = 0; k < 200; ++k) map.grow(k % 2 == 0 ? a : b, random_node(), {{Pose{}}});
  for (int k = 0; k < 200; ++k) {
    const Roadmap::Node probe = random_node();
    const Index tree = map.node(k % 2 == 0 ? a : b).tree;
    const Index found = map.nearest(probe.center, probe.turn, tree);
    for (const Index n : map.tree(tree).nodes)
      EXPECT_LE(map.distance(probe.center, probe.turn, map.node(found)),
                map.distance(probe.center, probe.turn, map.node(n)));
  }
}

}  // namespace
}  // namespace dismantle::tunnel_forest
