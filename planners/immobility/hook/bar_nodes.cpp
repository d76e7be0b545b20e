#include "hook/bar_nodes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr std::size_t kMostNodes = 1200;         // of its middle


}  // namespace

std::vector<Node> nodes_of(const std::vector<InnerBall>& balls, double depth) {
  std::vector<Node> nodes;
  for (const InnerBall& ball : balls) {
    const Node n{ball.center, ball.radius - depth};
    if (nodes.size() == kMostNodes || !(n.keep > 0.1 * depth)) break;
    // Balls in edges and corners, beside much larger ones.
    if (std::any_of(nodes.begin(), nodes.end(), [&](const Node& m) {
          const double apart = (m.at - n.at).norm();
          return apart < 0.3 * m.keep || (m.keep > 1.5 * n.keep && apart < 2 * m.keep);
        }))
      continue;
    nodes.push_back(n);
  }
  return nodes;
}

Joined join(const std::vector<Node>& nodes) {
  Joined joined(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if ((nodes[i].at - nodes[k].at).norm() < kJoined * (nodes[i].keep + nodes[k].keep)) {
        joined[i].push_back(k);
        joined[k].push_back(i);
      }
  return joined;
}

namespace {

/// Where the bar goes at a node.
Vec3 course(const std::vector<Node>& nodes, std::size_t node) {
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const Node& n : nodes) {
    const Vec3 d = n.at - nodes[node].at;
    if (d.norm() < 2 * nodes[node].keep) second += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(second);
  return axes.eigenvectors().col(2);
}

}  // namespace

std::vector<std::pair<Loop, std::size_t>> holes(const Surface& surface, const Solid& around,
                                                const std::vector<Node>& nodes, std::size_t most) {
  struct Tight {
    std::size_t node;
    Vec3 along;
    Loop loop;
  };
  std::vector<Tight> tight;
  const Pose to_local = around.frame.inverse();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vec3 local = to_local * nodes[i].at;
    const double reach = 4 * nodes[i].keep;
    if (!(around.bvh.closest(local, reach).distance < reach)) continue;
    const Vec3 along = course(nodes, i);
    for (Loop& loop : surface.section({along, along.dot(nodes[i].at)}))
      if (loop.around(nodes[i].at) && loop.diameter() < 2 * reach) tight.push_back({i, along, std::move(loop)});
  }
  // Those next to each other belong to one hole.
  std::vector<std::pair<Loop, std::size_t>> found;
  std::vector<char> taken(tight.size(), 0);
  for (std::size_t first = 0; first < tight.size() && found.size() < most; ++first) {
    if (taken[first]) continue;
    std::vector<std::size_t> hole{first};
    taken[first] = 1;
    for (std::size_t k = 0; k < hole.size(); ++k)
      for (std::size_t other = 0; other < tight.size(); ++other) {
        const Node &a = nodes[tight[hole[k]].node], &b = nodes[tight[other].node];
        if (taken[other] || (a.at - b.at).norm() > 2 * (a.keep + b.keep)) continue;
        taken[other] = 1;
        hole.push_back(other);
      }
    const Vec3 along = tight[first].along;
    std::stable_sort(hole.begin(), hole.end(), [&](std::size_t a, std::size_t b) {
      return along.dot(nodes[tight[a].node].at) < along.dot(nodes[tight[b].node].at);
    });
    const Tight& middle = tight[hole[hole.size() / 2]];
    found.emplace_back(middle.loop, middle.node);
  }
  return found;
}

}  // namespace dismantle::immobility
