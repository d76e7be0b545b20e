#include "mesh/slits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "dismantle/geometry/mesh_edges.h"

namespace dismantle::mesh_detail {
namespace {

using Eigen::Vector3d;
using Rim = std::vector<std::uint32_t>;

/// Width of a slit, as a share of its length: files state positions to four digits or more.
constexpr double kNarrow = 1e-3;
/// Cosine: surfaces that face opposite ways lie on each other.
constexpr double kOpposite = -0.9;

class SlitCloser {
 public:
  explicit SlitCloser(Mesh& mesh) : mesh_(mesh) {
    for_each_edge(sorted_edges(mesh), [&](const auto* first, const auto* last) {
      if (last - first != 1) return;
      at_[first->forward ? Edge(first->lo, first->hi) : Edge(first->hi, first->lo)] = first->triangle;
    });
  }

  bool close(const Rim& rim) {
    if (rim.size() < 3) return false;
    const std::optional<Rim> chain = along_longest(rim);
    if (!chain || !is_folded(*chain)) return false;
    const std::uint32_t from = chain->front(), to = chain->back();
    const auto found = at_.find({from, to});
    if (found == at_.end()) return false;
    const std::uint32_t split = found->second;
    const Triangle whole = mesh_.triangles[split];
    const std::uint32_t apex = whole[0] + whole[1] + whole[2] - from - to;
    if (std::find(chain->begin(), chain->end(), apex) != chain->end()) return false;
    at_.erase(found);
    for (std::size_t k = 0; k + 1 < chain->size(); ++k) {
      const auto piece = k == 0 ? split : static_cast<std::uint32_t>(mesh_.triangles.size());
      if (k > 0) mesh_.triangles.emplace_back();
      mesh_.triangles[piece] = {(*chain)[k], (*chain)[k + 1], apex};
      at_.erase({(*chain)[k + 1], (*chain)[k]});
      if (k + 2 < chain->size()) continue;
      if (const auto edge = at_.find({to, apex}); edge != at_.end()) edge->second = piece;
    }
    return true;
  }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  /// The rim as a chain beside its longest edge, from the end where the triangle at that edge begins it: nothing unless
  /// the hole is narrow and the chain never turns back.
  std::optional<Rim> along_longest(const Rim& rim) const {
    const auto point = [&](std::size_t k) -> const Vector3d& { return mesh_.vertices[rim[k % rim.size()]]; };
    std::size_t longest = 0;
    for (std::size_t k = 1; k < rim.size(); ++k)
      if ((point(k + 1) - point(k)).norm() > (point(longest + 1) - point(longest)).norm()) longest = k;
    const Vector3d begin = point(longest + 1), edge = point(longest) - begin;
    const double length = edge.norm();
    if (!(length > 0)) return std::nullopt;
    Rim chain;
    double reached = 0;
    for (std::size_t k = 0; k < rim.size(); ++k) {
      const Vector3d r = point(longest + 1 + k) - begin;
      const double along = r.dot(edge) / length;
      if (k > 0 && !(along > reached)) return std::nullopt;
      if ((r - along / length * edge).norm() > kNarrow * length) return std::nullopt;
      reached = along;
      chain.push_back(rim[(longest + 1 + k) % rim.size()]);
    }
    return chain;
  }

  /// Does a neighbour of the chain face the opposite way to a filling?
  bool is_folded(const Rim& chain) const {
    Vector3d filling = Vector3d::Zero();
    const Vector3d& origin = mesh_.vertices[chain.front()];
    for (std::size_t k = 1; k + 1 < chain.size(); ++k)
      filling += (mesh_.vertices[chain[k]] - origin).cross(mesh_.vertices[chain[k + 1]] - origin);
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
      const auto found = at_.find({chain[k + 1], chain[k]});
      if (found == at_.end()) continue;
      const Vector3d a = mesh_.vertex(found->second, 0),
                     normal = (mesh_.vertex(found->second, 1) - a).cross(mesh_.vertex(found->second, 2) - a);
      if (normal.dot(filling) < kOpposite * normal.norm() * filling.norm()) return true;
    }
    return false;
  }

  Mesh& mesh_;
  std::map<Edge, std::uint32_t> at_;  // triangles by their open edges, as they run
};

}  // namespace

std::vector<char> close_slits(Mesh& mesh, const std::vector<Rim>& rims) {
  SlitCloser closer(mesh);
  std::vector<char> closed;
  closed.reserve(rims.size());
  for (const Rim& rim : rims) closed.push_back(closer.close(rim) ? 1 : 0);
  return closed;
}

}  // namespace dismantle::mesh_detail
