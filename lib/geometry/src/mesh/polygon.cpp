#include <array>
#include <cmath>

#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/mesh_measure.h"
#include "mesh/cross2.h"

namespace dismantle {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Qualities this near count as equal, so that a part that is turned gets the same triangles.
constexpr double kEqualQuality = 1e-9;

/// The polygon projected along its mean normal (Newell), counter-clockwise; empty if it has no area.
std::vector<Vector2d> flatten(std::span<const Vector3d> corners) {
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += (corners[i] - corners[0]).cross(corners[(i + 1) % corners.size()] - corners[0]);
  const double length = normal.norm();
  if (!(length > 0) || !std::isfinite(length)) return {};
  const Vector3d n = normal / length, u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Vector2d> flat;
  for (const auto& p : corners) flat.emplace_back(u.dot(p - corners[0]), v.dot(p - corners[0]));
  return flat;
}

/// Remaining corners, in a ring.
class EarClipper {
 public:
  explicit EarClipper(std::vector<Vector2d> points) : p_(std::move(points)) {
    for (std::uint32_t i = 0; i < p_.size(); ++i) ring_.push_back(i);
    double extent = 0;
    for (const auto& q : p_) extent = std::max(extent, q.cwiseAbs().maxCoeff());
    flat_ = 1e-12 * extent * extent;
  }

  std::vector<Triangle> run() {
    std::vector<Triangle> out;
    std::size_t start = 0;
    while (ring_.size() > 3) {
      std::size_t ear = find_ear(start, flat_);
      if (ear == ring_.size()) ear = find_ear(0, -flat_);  // only corners on straight lines remain
      if (ear == ring_.size()) return {};
      out.push_back({at(ear, -1), at(ear, 0), at(ear, 1)});
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(ear));
      start = ear;  // skip one corner: fewer slivers than a fan
    }
    out.push_back({ring_[0], ring_[1], ring_[2]});
    return out;
  }

 private:
  std::uint32_t at(std::size_t i, int step) const {
    return ring_[(i + ring_.size() + static_cast<std::size_t>(step + 1) - 1) % ring_.size()];
  }

  /// First ear at or after `start` whose doubled area is above `least`; with few corners, the ear with the best shape.
  std::size_t find_ear(std::size_t start, double least) {
    const bool best_of_all = ring_.size() <= 64;
    std::size_t best = ring_.size();
    double best_quality = -1;
    // Limit of corner tests per polygon: enough for ten thousand corners of any realistic shape. Spirals without nearby
    // ears would need cubic time.
    for (std::size_t k = 0; k < ring_.size() && tests_ < 400'000'000; ++k) {
      const std::size_t i = (start + k) % ring_.size();
      const Vector2d &a = p_[at(i, -1)], &b = p_[at(i, 0)], &c = p_[at(i, 1)];
      const double area = cross2(b - a, c - b);
      if (!(area > least) || !empty_ear(i)) continue;
      if (!best_of_all) return i;
      const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
      const double quality = longest > 0 ? std::max(area, 0.0) / longest : 0;
      if (quality > best_quality + kEqualQuality) {
        best = i;
        best_quality = quality;
      }
    }
    return best;
  }

  bool empty_ear(std::size_t i) {
    const std::uint32_t ia = at(i, -1), ib = at(i, 0), ic = at(i, 1);
    const Vector2d &a = p_[ia], &b = p_[ib], &c = p_[ic];
    for (const std::uint32_t j : ring_) {
      ++tests_;
      if (j == ia || j == ib || j == ic) continue;
      const Vector2d& q = p_[j];
      if (q == a || q == b || q == c) continue;
      if (cross2(b - a, q - a) >= -flat_ && cross2(c - b, q - b) >= -flat_ && cross2(a - c, q - c) >= flat_)
        return false;
    }
    return true;
  }

  std::vector<Vector2d> p_;
  std::vector<std::uint32_t> ring_;
  std::uint64_t tests_ = 0;
  double flat_ = 0;  // doubled areas below this count as straight lines
};

}  // namespace

std::vector<Triangle> triangulate_polygon(std::span<const Eigen::Vector3d> corners) {
  if (corners.size() < 3) return {};
  if (corners.size() == 3) return {{0, 1, 2}};
  auto flat = flatten(corners);
  if (flat.empty()) return {};
  return EarClipper(std::move(flat)).run();
}

}  // namespace dismantle
