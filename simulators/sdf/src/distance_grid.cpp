#include "dismantle/sdf/distance_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dismantle::sdf {
namespace {
constexpr float kFar = 1e30f;  // not computed yet; above any distance, with finite sums
}  // namespace

DistanceGrid::DistanceGrid(const Solid& solid, const SurfaceQuery& surface, const GridOptions& options)
    : exact_everywhere_(options.exact) {
  const int padding = options.exact ? 1 : 3;  // cells around the box: the narrow band fits, and rays start outside
  const Aabb box = solid.mesh.box();
  const Eigen::Vector3d size = box.size();
  for (int a = 0; a < 3; ++a) {
    cell_[a] = std::min(options.cell, size[a] / options.cells_per_edge);
    if (!(cell_[a] > 0)) cell_[a] = options.cell;
  }
  const auto count = [&](const Eigen::Vector3d& cell) {
    Eigen::Array3i n;
    for (int a = 0; a < 3; ++a) n[a] = static_cast<int>(std::ceil(size[a] / cell[a] - 1e-9)) + 1 + 2 * padding;
    return n;
  };
  nodes_ = count(cell_);
  while (nodes_.cast<double>().prod() > static_cast<double>(options.max_nodes)) {
    cell_ *= 1.25;
    nodes_ = count(cell_);
  }
  inverse_cell_ = cell_.cwiseInverse();
  origin_ = box.lo - padding * cell_;
  band_ = options.exact ? std::numeric_limits<double>::infinity() : 1.5 * cell_.maxCoeff();
  last_ = (nodes_ - 1).cast<double>();
  rounding_ = std::numeric_limits<float>::epsilon() * (last_ * cell_.array()).matrix().norm();
  box_ = {origin_, origin_ + (last_ * cell_.array()).matrix()};
  const auto total = static_cast<std::size_t>(nodes_.cast<std::int64_t>().prod());
  values_.assign(total, kFar);
  if (options.exact) {
    fill(surface);
    return;
  }
  exact_.assign(total, 0);
  fill_band(solid, surface);
  propagate_signs();
  sweep();
  exact_ = {};
}

/// The neighbour's distance plus the step between them limits the search at each node.
void DistanceGrid::fill(const SurfaceQuery& surface) {
  for (int k = 0; k < nodes_[2]; ++k)
    for (int j = 0; j < nodes_[1]; ++j) {
      double limit = std::numeric_limits<double>::infinity();
      std::uint32_t hint = geometry::kNoIndex;
      for (int i = 0; i < nodes_[0]; ++i) {
        const Sample s = surface.sample(origin_ + Eigen::Vector3d(i, j, k).cwiseProduct(cell_), limit, hint);
        values_[index(i, j, k)] = static_cast<float>(s.value);
        limit = std::abs(s.value) + cell_[0] + rounding_;
        hint = s.triangle;
      }
    }
}

/// Sets the exact signed distance at all nodes within about one cell of a triangle. Candidates are the nodes in the box
/// of each triangle and near its plane, with one exact query each.
void DistanceGrid::fill_band(const Solid& solid, const SurfaceQuery& surface) {
  const double reach = 1.01 * cell_.maxCoeff();
  for (std::uint32_t t = 0; t < solid.mesh.triangles.size(); ++t) {
    Aabb box;
    for (int k = 0; k < 3; ++k) box.extend(solid.mesh.vertex(t, k));
    box.inflate(reach);
    Eigen::Array3i lo, hi;
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::max(0, static_cast<int>(std::ceil((box.lo[a] - origin_[a]) * inverse_cell_[a])));
      hi[a] = std::min(nodes_[a] - 1, static_cast<int>(std::floor((box.hi[a] - origin_[a]) * inverse_cell_[a])));
    }
    const Eigen::Vector3d n = solid.face_normal[t];
    const double offset = n.dot(solid.mesh.vertex(t, 0));
    for (int k = lo[2]; k <= hi[2]; ++k)
      for (int j = lo[1]; j <= hi[1]; ++j) {
        // The plane distance is linear in i along this row: only a range of nodes is near the plane.
        const double y = origin_[1] + j * cell_[1], z = origin_[2] + k * cell_[2];
        const double base = n.x() * origin_[0] + n.y() * y + n.z() * z - offset, slope = n.x() * cell_[0];
        int from = lo[0], to = hi[0];
        if (std::abs(slope) > 1e-12) {
          const double u = (-reach - base) / slope, v = (reach - base) / slope;
          from = std::max(from, static_cast<int>(std::ceil(std::max(std::min(u, v), -1.0))));
          to = std::min(to, static_cast<int>(std::floor(std::min(std::max(u, v), 1e9))));
        } else if (std::abs(base) > reach) {
          continue;
        }
        for (int i = from; i <= to; ++i) {
          const std::size_t at = index(i, j, k);
          if (exact_[at] != 0) continue;
          const Eigen::Vector3d p(origin_[0] + i * cell_[0], y, z);
          const Sample s = surface.sample(p, band_, t);
          if (s.triangle == geometry::kNoIndex) continue;
          values_[at] = static_cast<float>(s.value);
          exact_[at] = 1;
        }
      }
  }
}

/// Along a row the sign changes only at exact nodes, since the band is wider than a cell.
void DistanceGrid::propagate_signs() {
  for (int k = 0; k < nodes_[2]; ++k)
    for (int j = 0; j < nodes_[1]; ++j) {
      bool inside = false;
      for (int i = 0; i < nodes_[0]; ++i) {
        const std::size_t at = index(i, j, k);
        if (exact_[at] != 0)
          inside = values_[at] < 0;
        else
          values_[at] = inside ? -kFar : kFar;
      }
    }
}

void DistanceGrid::sweep() {
  const double hx = cell_[0], hy = cell_[1], hz = cell_[2];
  const double wx = 1 / (hx * hx), wy = 1 / (hy * hy), wz = 1 / (hz * hz);
  const int nx = nodes_[0], ny = nodes_[1], nz = nodes_[2];
  const auto magnitude = [&](std::size_t at) { return std::abs(static_cast<double>(values_[at])); };
  const std::size_t sy = static_cast<std::size_t>(nx), sz = sy * static_cast<std::size_t>(ny);
  // Smallest solution u of the upwind Eikonal equation sum_i max(u - a_i, 0)^2 w_i = 1.
  const auto solve = [&](double a, double b, double c) {
    double va[3] = {a, b, c}, w[3] = {wx, wy, wz};
    if (va[0] > va[1]) std::swap(va[0], va[1]), std::swap(w[0], w[1]);
    if (va[1] > va[2]) std::swap(va[1], va[2]), std::swap(w[1], w[2]);
    if (va[0] > va[1]) std::swap(va[0], va[1]), std::swap(w[0], w[1]);
    double u = va[0] + 1 / std::sqrt(w[0]);
    if (u <= va[1]) return u;
    double sw = w[0] + w[1], sa = w[0] * va[0] + w[1] * va[1];
    double q = w[0] * va[0] * va[0] + w[1] * va[1] * va[1] - 1;
    u = (sa + std::sqrt(std::max(0.0, sa * sa - sw * q))) / sw;
    if (u <= va[2]) return u;
    sw += w[2];
    sa += w[2] * va[2];
    q += w[2] * va[2] * va[2];
    return (sa + std::sqrt(std::max(0.0, sa * sa - sw * q))) / sw;
  };
  for (int pass = 0; pass < 8; ++pass) {
    const bool fx = (pass & 1) == 0, fy = (pass & 2) == 0, fz = (pass & 4) == 0;
    for (int kk = 0; kk < nz; ++kk) {
      const int k = fz ? kk : nz - 1 - kk;
      for (int jj = 0; jj < ny; ++jj) {
        const int j = fy ? jj : ny - 1 - jj;
        std::size_t at = index(fx ? 0 : nx - 1, j, k);
        for (int ii = 0; ii < nx; ++ii, at += fx ? std::size_t{1} : ~std::size_t{0}) {
          if (exact_[at] != 0) continue;
          const int i = fx ? ii : nx - 1 - ii;
          const double a = std::min(i > 0 ? magnitude(at - 1) : kFar, i + 1 < nx ? magnitude(at + 1) : kFar);
          const double b = std::min(j > 0 ? magnitude(at - sy) : kFar, j + 1 < ny ? magnitude(at + sy) : kFar);
          const double c = std::min(k > 0 ? magnitude(at - sz) : kFar, k + 1 < nz ? magnitude(at + sz) : kFar);
          const double old = magnitude(at);
          if (std::min({a, b, c}) >= old) continue;
          const double u = solve(a, b, c);
          if (u < old) values_[at] = static_cast<float>(std::copysign(u, static_cast<double>(values_[at])));
        }
      }
    }
  }
}

/// The cell that contains p (clamped to the grid), and the position of p in it.
inline DistanceGrid::Place DistanceGrid::locate(const Eigen::Vector3d& p) const {
  const Eigen::Array3d g = ((p - origin_).array() * inverse_cell_.array()).max(0.0).min(last_);
  const Eigen::Array3i base = g.cast<int>().min(nodes_ - 2);
  return {index(base.x(), base.y(), base.z()), g - base.cast<double>()};
}

/// Trilinear, on pairs of values so that each operation handles two: along x for both rows of a slice, then along z,
/// then along y.
inline double DistanceGrid::interpolate(const Place& place, Eigen::Vector3d* gradient) const {
  const float* v = values_.data() + place.first;
  const std::size_t sy = static_cast<std::size_t>(nodes_[0]), sz = sy * static_cast<std::size_t>(nodes_[1]);
  using Pair = Eigen::Array2d;
  const auto pair = [&](std::size_t at) { return Pair(v[at], v[at + sy]); };
  const double x = place.share.x(), y = place.share.y(), z = place.share.z();
  const Pair near = pair(0), far = pair(sz);
  const Pair near_x = pair(1) - near, far_x = pair(sz + 1) - far;
  const Pair near_at = near + x * near_x, along_z = (far + x * far_x) - near_at;
  const Pair at = near_at + z * along_z;
  const double along_y = at[1] - at[0];
  if (gradient != nullptr) {
    const Pair along_x = near_x + z * (far_x - near_x);
    *gradient =
        Eigen::Vector3d((along_x[0] + y * (along_x[1] - along_x[0])) * inverse_cell_[0], along_y * inverse_cell_[1],
                        (along_z[0] + y * (along_z[1] - along_z[0])) * inverse_cell_[2]);
  }
  return at[0] + y * along_y;
}

double DistanceGrid::value(const Eigen::Vector3d& p) const {
  const double inside = interpolate(locate(p), nullptr);
  return box_.contains(p) ? inside : inside + std::sqrt(box_.squared_distance(p));
}

double DistanceGrid::value(const Eigen::Vector3d& p, Eigen::Vector3d& gradient) const {
  double value = interpolate(locate(p), &gradient);
  if (!box_.contains(p)) {
    // Beyond the grid: extended from the nearest point of the grid.
    const Eigen::Vector3d beyond = p - p.cwiseMax(box_.lo).cwiseMin(box_.hi);
    gradient = gradient * std::max(value, 0.0) + beyond;
    value += beyond.norm();
  }
  // Gradients of distances are of order 1, so nothing overflows.
  if (const double squared = gradient.squaredNorm(); squared > std::numeric_limits<float>::min())
    gradient *= 1 / std::sqrt(squared);
  return value;
}

double DistanceGrid::lower_bound(const Eigen::Vector3d& p) const {
  // The solid's box lies inside the grid: the distance to the grid is a true bound.
  if (!box_.contains(p)) return std::sqrt(box_.squared_distance(p));
  const Place place = locate(p);
  const double value = interpolate(place, nullptr);
  // Distance is 1-Lipschitz; the interpolated distances to the nodes are at most the root of their interpolated
  // squares.
  if (exact_everywhere_) {
    const double squared = (place.share * (1 - place.share) * cell_.array().square()).sum();
    return std::max(0.0, value - std::sqrt(squared) - rounding_);
  }
  // First-order sweeping overestimates by less than a tenth of the distance plus a cell's diagonal.
  return std::max(0.0, 0.9 * value - 1.5 * cell_.norm());
}

}  // namespace dismantle::sdf
