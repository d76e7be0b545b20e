#include <fmt/format.h>

#include <queue>
#include <unordered_map>

#include "dismantle/errors.h"
#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/mesh_subdivide.h"

namespace dismantle {
namespace {

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
}

class Subdivider {
 public:
  Subdivider(Mesh mesh, double max_edge, std::size_t max_triangles)
      : mesh_(std::move(mesh)), limit_(max_edge * max_edge), max_triangles_(max_triangles) {
    triangles_at_.reserve(mesh_.triangles.size() * 2);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) attach(mesh_.triangles[t][c], mesh_.triangles[t][(c + 1) % 3], t);
  }

  Mesh run(double max_edge) {
    while (!queue_.empty()) {
      const std::uint64_t key = queue_.top().key;
      queue_.pop();
      const auto found = triangles_at_.find(key);
      if (found == triangles_at_.end()) continue;
      const std::vector<std::uint32_t> around = std::move(found->second);
      triangles_at_.erase(found);
      split(static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key), around);
      if (mesh_.triangles.size() > max_triangles_)
        throw InputError("assembly.subdivide",
                         fmt::format("edges no longer than {} take more than {} triangles: raise assembly.subdivide",
                                     max_edge, max_triangles_));
    }
    return std::move(mesh_);
  }

 private:
  struct Entry {
    double length;
    std::uint64_t key;
    bool operator<(const Entry& o) const { return length != o.length ? length < o.length : key > o.key; }
  };

  void attach(std::uint32_t a, std::uint32_t b, std::uint32_t triangle) {
    const std::uint64_t key = key_of(a, b);
    auto& around = triangles_at_[key];
    if (around.empty()) {
      const double length = (mesh_.vertices[a] - mesh_.vertices[b]).squaredNorm();
      if (length > limit_) queue_.push({length, key});
    }
    around.push_back(triangle);
  }

  void split(std::uint32_t a, std::uint32_t b, const std::vector<std::uint32_t>& around) {
    const auto m = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(0.5 * (mesh_.vertices[a] + mesh_.vertices[b]));
    for (const std::uint32_t t : around) {
      const Triangle old = mesh_.triangles[t];
      std::size_t i = 0;
      while (key_of(old[i], old[(i + 1) % 3]) != key_of(a, b)) ++i;
      const std::uint32_t p = old[i], q = old[(i + 1) % 3], r = old[(i + 2) % 3];
      const auto fresh = static_cast<std::uint32_t>(mesh_.triangles.size());
      mesh_.triangles[t] = {p, m, r};
      mesh_.triangles.push_back({m, q, r});
      for (auto& triangle : triangles_at_.at(key_of(q, r)))
        if (triangle == t) triangle = fresh;
      attach(p, m, t);
      attach(m, q, fresh);
      attach(m, r, t);
      attach(m, r, fresh);
    }
  }

  Mesh mesh_;
  double limit_;
  std::size_t max_triangles_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> triangles_at_;  // only for lookup: no order needed
  std::priority_queue<Entry> queue_;                                            // edges that are too long
};

}  // namespace

Mesh subdivide(const Mesh& mesh, double max_edge, std::size_t max_triangles) {
  bool fine = true;
  for (std::size_t t = 0; fine && t < mesh.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c)
      fine = fine && (mesh.vertex(t, c) - mesh.vertex(t, (c + 1) % 3)).squaredNorm() <= max_edge * max_edge;
  if (fine) return mesh;
  return Subdivider(mesh, max_edge, max_triangles).run(max_edge);
}

}  // namespace dismantle
