#include "dismantle/immobility/section.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "dismantle/geometry/numerics.h"

namespace dismantle::immobility {
namespace {

using Vec3 = Eigen::Vector3d;

/// The distance along `d` from `p` to the triangle; nothing when the ray misses it, infinite when rounding decides.
std::optional<double> meets(const Vec3& p, const Vec3& d, const std::array<Vec3, 3>& c) {
  const Vec3 u = c[1] - c[0], v = c[2] - c[0], across = d.cross(v);
  const double det = u.dot(across), size = u.norm() * v.norm();
  const Vec3 from = p - c[0];
  if (std::abs(det) <= kRounding * size) {
    const Vec3 normal = u.cross(v);
    if (!(normal.norm() > 1e-14 * size)) return std::nullopt;  // degenerate: parallel edges in double precision
    const bool in_plane = std::abs(from.dot(normal.normalized())) <= kRounding * (from.norm() + u.norm() + v.norm());
    return in_plane ? std::optional(std::numeric_limits<double>::infinity()) : std::nullopt;
  }
  const double a = from.dot(across) / det;
  const Vec3 q = from.cross(u);
  const double b = d.dot(q) / det, at = v.dot(q) / det;
  const double near = kRounding * (u.norm() + v.norm());  // of a point on the triangle
  if (a < -kRounding || b < -kRounding || a + b > 1 + kRounding || at < -near) return std::nullopt;
  if (a < kRounding || b < kRounding || a + b > 1 - kRounding || at < near)
    return std::numeric_limits<double>::infinity();
  return at;
}

}  // namespace

std::vector<std::size_t> Loop::hull() const {
  const Vec3 e = plane.normal.unitOrthogonal(), f = plane.normal.cross(e);
  struct Point {
    double x, y;
    std::size_t index;
  };
  std::vector<Point> order;
  for (std::size_t k = 0; k < points.size(); ++k) order.push_back({e.dot(points[k]), f.dot(points[k]), k});
  std::sort(order.begin(), order.end(), [](const Point& a, const Point& b) {
    return a.x < b.x || (a.x == b.x && (a.y < b.y || (a.y == b.y && a.index < b.index)));
  });
  std::vector<Point> corners;
  for (const bool upper : {false, true}) {  // a monotone chain below, then one above
    const std::size_t first = corners.size();
    for (const Point& p : order) {
      while (corners.size() > first + 1) {
        const Point &a = corners[corners.size() - 2], &b = corners.back();
        if ((b.x - a.x) * (p.y - b.y) - (b.y - a.y) * (p.x - b.x) > 0) break;
        corners.pop_back();
      }
      corners.push_back(p);
    }
    if (!corners.empty()) corners.pop_back();
    if (!upper) std::reverse(order.begin(), order.end());
  }
  std::vector<std::size_t> indices;
  for (const Point& p : corners) indices.push_back(p.index);
  return indices;
}

double Loop::diameter() const {
  const std::vector<std::size_t> corners = hull();
  double most = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) most = std::max(most, (points[corners[i]] - points[corners[k]]).squaredNorm());
  return std::sqrt(most);
}

bool Loop::around(const Vec3& p) const {
  const Vec3 e = plane.normal.unitOrthogonal(), f = plane.normal.cross(e);
  const double x = e.dot(p), y = f.dot(p);
  bool inside = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 &a = points[i], &b = points[(i + 1) % points.size()];
    const double ya = f.dot(a), yb = f.dot(b);
    if ((ya > y) == (yb > y)) continue;
    if (x < e.dot(a) + (y - ya) / (yb - ya) * (e.dot(b) - e.dot(a))) inside = !inside;
  }
  return inside;
}

Surface::Surface(const Solid& solid) : triangles_(solid.mesh.triangles) {
  for (const Vec3& v : solid.mesh.vertices) vertices_.push_back(solid.frame * v);
  size_ = solid.box.size().norm();
  neighbours_.assign(triangles_.size(), {kNoIndex, kNoIndex, kNoIndex});
  // Every directed edge has its opposite. Where more than two triangles meet, any pairing gives closed curves.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::uint32_t, std::uint32_t>>> open;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles_[t][k], b = triangles_[t][(k + 1) % 3];
      if (auto& opposite = open[{b, a}]; !opposite.empty()) {
        const auto [other, edge] = opposite.back();
        opposite.pop_back();
        neighbours_[t][k] = other;
        neighbours_[other][edge] = t;
      } else {
        open[{a, b}].emplace_back(t, k);
      }
    }
}

std::vector<double> Surface::offsets(const Vec3& direction, std::size_t most) const {
  std::vector<double> all;
  for (const Vec3& v : vertices_) all.push_back(direction.dot(v));
  std::sort(all.begin(), all.end());
  std::vector<double> heights;
  for (const double h : all)
    if (heights.empty() || h > heights.back() + 1e-7 * size_) heights.push_back(h);  // else in one plane up to rounding
  std::vector<double> offsets;
  const std::size_t step = 1 + 3 * heights.size() / most;
  for (std::size_t k = 0; k + 1 < heights.size(); k += step)
    for (const double share : {0.001, 0.5, 0.999})
      offsets.push_back(heights[k] + share * (heights[k + 1] - heights[k]));
  return offsets;
}

bool Surface::connects(const Loop& from, const Loop& to, bool above) const {
  std::vector<char> seen(triangles_.size(), 0);
  std::vector<std::uint32_t> open = from.triangles;
  for (const std::uint32_t t : open) seen[t] = 1;
  const auto on_side = [&](std::uint32_t v) { return (from.plane.height(vertices_[v]) > 0) == above; };
  while (!open.empty()) {
    const std::uint32_t t = open.back();
    open.pop_back();
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t next = neighbours_[t][k];
      if (next == kNoIndex || seen[next]) continue;
      if (!on_side(triangles_[t][k]) && !on_side(triangles_[t][(k + 1) % 3])) continue;
      seen[next] = 1;
      open.push_back(next);
    }
  }
  return std::any_of(to.triangles.begin(), to.triangles.end(), [&](std::uint32_t t) { return seen[t] != 0; });
}

std::vector<Loop> Surface::section(const Plane& plane) const {
  const auto above = [&](std::uint32_t v) { return plane.height(vertices_[v]) > 0; };
  // Always from the lower end of the edge, so that both of its triangles get the same point.
  const auto cut = [&](std::uint32_t t, std::uint32_t k) {
    Vec3 a = vertices_[triangles_[t][k]], b = vertices_[triangles_[t][(k + 1) % 3]];
    if (plane.height(a) > 0) std::swap(a, b);
    const double ha = plane.height(a), hb = plane.height(b);
    return Vec3(a + ha / (ha - hb) * (b - a));
  };
  std::vector<Loop> loops;
  std::vector<char> seen(triangles_.size(), 0);
  for (std::uint32_t first = 0; first < triangles_.size(); ++first) {
    const auto is_cut = [&](std::uint32_t t) {
      const auto& c = triangles_[t];
      return above(c[0]) != above(c[1]) || above(c[1]) != above(c[2]);
    };
    if (seen[first] || !is_cut(first)) continue;
    Loop loop{plane, {}, {}};
    bool closed = true;
    for (std::uint32_t t = first; !seen[t];) {
      seen[t] = 1;
      // Enters through the edge that goes down and leaves through the one that goes up, so all loops turn one way.
      std::uint32_t in = 0, out = 0;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const bool from = above(triangles_[t][k]), to = above(triangles_[t][(k + 1) % 3]);
        if (from && !to) in = k;
        if (!from && to) out = k;
      }
      loop.points.push_back(cut(t, in));
      loop.triangles.push_back(t);
      t = neighbours_[t][out];
      if (t == kNoIndex) {
        closed = false;
        break;
      }
    }
    if (!closed) continue;
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::optional<Surface::Closed> Surface::closed_by(const std::vector<Loop>& loops, const Vec3& p) const {
  std::vector<std::vector<std::size_t>> on(triangles_.size());
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (const std::uint32_t t : loops[i].triangles) on[t].push_back(i);
  const auto sign = [&](std::size_t i) { return loops[i].plane.height(p) > 0 ? 1.0 : -1.0; };
  Closed result;
  result.rounding_ = kRounding * size_;
  std::vector<char> seen(triangles_.size(), 0), used(loops.size(), 0);
  std::vector<std::uint32_t> open{loops.front().triangles.front()};
  seen[open.front()] = 1;
  while (!open.empty()) {
    const std::uint32_t t = open.back();
    open.pop_back();
    Closed::Piece piece{{vertices_[triangles_[t][0]], vertices_[triangles_[t][1]], vertices_[triangles_[t][2]]}, {}};
    for (const std::size_t i : on[t]) {
      used[i] = 1;
      piece.kept.emplace_back(loops[i].plane, sign(i));
    }
    for (std::uint32_t k = 0; k < 3; ++k) {
      // Tests whether a piece of this edge is kept. An end exactly in a plane counts as below it, as in section().
      const std::uint32_t a = triangles_[t][k], b = triangles_[t][(k + 1) % 3];
      bool kept = true;
      for (const std::size_t i : on[t]) {
        const auto on_side = [&](std::uint32_t v) {
          return (loops[i].plane.height(vertices_[v]) > 0) == (sign(i) > 0);
        };
        kept = kept && (on_side(a) || on_side(b));
      }
      if (!kept) continue;
      const std::uint32_t next = neighbours_[t][k];
      if (next == kNoIndex) return std::nullopt;
      // Tests whether the surface reaches the other side of a loop.
      for (const std::size_t i : on[next]) {
        const auto off_side = [&](std::uint32_t v) {
          return (loops[i].plane.height(vertices_[v]) > 0) != (sign(i) > 0);
        };
        if (off_side(a) && off_side(b)) return std::nullopt;
      }
      if (!seen[next]) {
        seen[next] = 1;
        open.push_back(next);
      }
    }
    result.pieces_.push_back(std::move(piece));
  }
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (used[i]) result.discs_.push_back(&loops[i]);
  return result;
}

std::optional<bool> Surface::Closed::inside(const Vec3& p) const {
  // Five directions off the axes and diagonals of usual models, where rays meet edges.
  static const std::array<Vec3, 5> rays = {Vec3(0.61, 0.37, 0.70), Vec3(-0.53, 0.81, 0.25), Vec3(0.29, -0.44, 0.85),
                                           Vec3(0.71, 0.13, -0.69), Vec3(-0.38, -0.91, 0.17)};
  std::optional<bool> answer;
  for (const Vec3& ray : rays) {
    const Vec3 d = ray.normalized();
    std::size_t crossings = 0;
    bool clear = true;
    for (const Piece& piece : pieces_) {
      const auto at = meets(p, d, piece.corners);
      if (!at) continue;
      if (std::isinf(*at)) clear = false;
      if (!clear) break;
      const Vec3 x = p + *at * d;
      bool kept = true;
      for (const auto& [plane, sign] : piece.kept) {
        const double h = sign * plane.height(x);
        if (std::abs(h) < rounding_) clear = false;
        kept = kept && h > 0;
      }
      if (kept) ++crossings;
    }
    for (const Loop* loop : discs_) {
      const double slope = loop->plane.normal.dot(d);
      if (std::abs(slope) < kRounding) clear = false;
      if (!clear) break;
      const double at = -loop->plane.height(p) / slope;
      if (at > 0 && loop->around(p + at * d)) ++crossings;
    }
    if (!clear) continue;
    const bool odd = crossings % 2 == 1;
    if (answer && *answer != odd) return std::nullopt;
    answer = odd;
  }
  return answer;
}

}  // namespace dismantle::immobility
