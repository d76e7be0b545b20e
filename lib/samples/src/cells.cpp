#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "solids.h"

namespace dismantle::samples {
namespace {

/// The planes of a grid along one axis, ascending; coordinates that differ only by rounding give one plane.
class Planes {
 public:
  explicit Planes(std::vector<double> all) : planes_(std::move(all)) {
    std::sort(planes_.begin(), planes_.end());
    same_ = 1e-9 * std::max(std::abs(planes_.front()), std::abs(planes_.back()));
    planes_.erase(std::unique(planes_.begin(), planes_.end(), [this](double a, double b) { return b - a < same_; }),
                  planes_.end());
  }
  std::size_t index(double x) const {
    return static_cast<std::size_t>(std::lower_bound(planes_.begin(), planes_.end(), x - same_) - planes_.begin());
  }
  std::size_t size() const { return planes_.size(); }
  double operator[](std::size_t i) const { return planes_[i]; }

 private:
  std::vector<double> planes_;
  double same_ = 0;  // mm
};

}  // namespace

Cells& Cells::add(const Point& lo, const Point& hi) {
  ops_.push_back({lo, hi, true});
  return *this;
}

Cells& Cells::cut(const Point& lo, const Point& hi) {
  ops_.push_back({lo, hi, false});
  return *this;
}

Mesh Cells::mesh() const {
  const auto planes_across = [this](int axis) {
    std::vector<double> all;
    for (const auto& op : ops_) all.insert(all.end(), {op.lo[axis], op.hi[axis]});
    return Planes(std::move(all));
  };
  const std::array<Planes, 3> planes{planes_across(0), planes_across(1), planes_across(2)};
  const std::array<std::size_t, 3> n = {planes[0].size() - 1, planes[1].size() - 1, planes[2].size() - 1};
  std::vector<char> solid(n[0] * n[1] * n[2], 0);
  const auto at = [&n](std::size_t i, std::size_t j, std::size_t k) { return (k * n[1] + j) * n[0] + i; };
  for (const auto& op : ops_) {
    std::array<std::size_t, 3> lo{}, hi{};
    for (std::size_t a = 0; a < 3; ++a) {
      lo[a] = planes[a].index(op.lo[static_cast<int>(a)]);
      hi[a] = planes[a].index(op.hi[static_cast<int>(a)]);
    }
    for (std::size_t k = lo[2]; k < hi[2]; ++k)
      for (std::size_t j = lo[1]; j < hi[1]; ++j)
        for (std::size_t i = lo[0]; i < hi[0]; ++i) solid[at(i, j, k)] = op.solid;
  }

  Mesh mesh;
  std::map<std::array<std::size_t, 3>, std::uint32_t> ids;
  const auto vertex = [&](const std::array<std::size_t, 3>& g) {
    const auto [entry, fresh] = ids.try_emplace(g, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh) mesh.vertices.emplace_back(planes[0][g[0]], planes[1][g[1]], planes[2][g[2]]);
    return entry->second;
  };
  for (std::size_t k = 0; k < n[2]; ++k)
    for (std::size_t j = 0; j < n[1]; ++j)
      for (std::size_t i = 0; i < n[0]; ++i) {
        if (!solid[at(i, j, k)]) continue;
        const std::array<std::size_t, 3> cell = {i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (const bool upper : {false, true}) {
            auto next = cell;
            const bool edge = upper ? cell[axis] + 1 == n[axis] : cell[axis] == 0;
            if (!edge) {
              next[axis] = upper ? cell[axis] + 1 : cell[axis] - 1;
              if (solid[at(next[0], next[1], next[2])]) continue;
            }
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::array<std::uint32_t, 4> q{};
            for (std::size_t c = 0; c < 4; ++c) {
              auto g = cell;
              if (upper) ++g[axis];
              if (c == 1 || c == 2) ++g[u];
              if (c >= 2) ++g[v];
              q[c] = vertex(g);
            }
            if (!upper) std::swap(q[1], q[3]);
            mesh.triangles.push_back({q[0], q[1], q[2]});
            mesh.triangles.push_back({q[0], q[2], q[3]});
          }
      }
  return mesh;
}

}  // namespace dismantle::samples
