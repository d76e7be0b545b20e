#include "disc/facets.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "dismantle/geometry/numerics.h"

namespace dismantle::immobility {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Loop = std::vector<std::uint32_t>;  // numbers of corners, counter-clockwise

/// A right turn within rounding counts as straight.
bool turns_left(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 u = b - a, v = c - b;
  const double turn = cross(u, v), slack = 0.1 * kRounding * u.norm() * v.norm();
  return turn > slack || (turn >= -slack && u.dot(v) > 0);
}

/// Merges two pieces across the edge that is u, v in the first and v, u in the second. Empty if that is not convex.
Loop joined(const Loop& a, const Loop& b, std::uint32_t u, std::uint32_t v, const std::vector<Vec2>& at) {
  const auto find = [](const Loop& p, std::uint32_t from, std::uint32_t to) {
    std::size_t k = 0;
    while (k < p.size() && (p[k] != from || p[(k + 1) % p.size()] != to)) ++k;
    return k;
  };
  const std::size_t i = find(a, u, v), j = find(b, v, u);
  if (i == a.size() || j == b.size()) return {};
  Loop whole;
  for (std::size_t k = 1; k <= a.size(); ++k) whole.push_back(a[(i + k) % a.size()]);  // from v around a to u
  for (std::size_t k = 2; k < b.size(); ++k) whole.push_back(b[(j + k) % b.size()]);   // from u around b to v
  const std::size_t n = whole.size();
  for (const std::size_t k : {std::size_t{0}, a.size() - 1})
    if (!turns_left(at[whole[(k + n - 1) % n]], at[whole[k]], at[whole[(k + 1) % n]])) return {};
  return whole;
}

}  // namespace

/// The triangles of a solid during merging.
struct Facets::Shell {
  const std::vector<Triangle>& triangles;
  std::vector<Vec3> at;
  double off;                 // the largest distance from a plane of points in it
  std::vector<Vec2> flat;     // corners, in the plane of the current region
  std::vector<double> twice;  // areas, doubled
  std::vector<bool> taken;
  std::map<Edge, std::uint32_t> across;  // the triangle of each directed edge

  Vec3 normal(std::uint32_t t) const {
    const auto& [a, b, c] = triangles[t];
    return (at[b] - at[a]).cross(at[c] - at[a]);
  }
  bool in(const FacetPlane& plane, std::uint32_t t) const {
    return std::all_of(triangles[t].begin(), triangles[t].end(),
                       [&](std::uint32_t v) { return std::abs(plane.height(at[v])) < off; });
  }
};

Facets::Facets(const std::vector<Solid>& solids, double slack) : slack_(slack) {
  const auto smaller = [](const Solid& a, const Solid& b) { return a.box.size().norm() < b.box.size().norm(); };
  if (const auto most = std::max_element(solids.begin(), solids.end(), smaller); most != solids.end())
    frame_ = most->frame;
  for (const Solid& s : solids) add(s);
  for (const Facet& f : facets_) box_.extend(f.box);
}

/// The largest triangles first, since their normals are the most accurate.
void Facets::add(const Solid& solid) {
  const Pose to_here = frame_.inverse() * solid.frame;
  Shell shell{solid.mesh.triangles, {}, 0.1 * slack_, {}, {}, {}, {}};
  for (const Vec3& v : solid.mesh.vertices) shell.at.push_back(to_here * v);
  shell.flat.resize(shell.at.size());
  shell.taken.assign(shell.triangles.size(), false);
  for (std::uint32_t t = 0; t < shell.triangles.size(); ++t) {
    shell.twice.push_back(shell.normal(t).norm());
    for (int k = 0; k < 3; ++k) shell.across[{shell.triangles[t][k], shell.triangles[t][(k + 1) % 3]}] = t;
  }
  std::vector<std::uint32_t> order(shell.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return shell.twice[a] > shell.twice[b]; });
  for (const std::uint32_t seed : order)
    if (!shell.taken[seed] && shell.twice[seed] > 0) add_region(shell, seed, plane_through(shell, seed));
}

std::uint32_t Facets::plane_through(const Shell& shell, std::uint32_t triangle) {
  FacetPlane plane;
  plane.normal = shell.normal(triangle).normalized();
  plane.offset = plane.normal.dot(shell.at[shell.triangles[triangle][0]]);
  auto number = static_cast<std::uint32_t>(planes_.size());
  const double off = std::abs(plane.offset);
  for (auto k = by_offset_.lower_bound(off - slack_); k != by_offset_.end() && k->first < off + slack_; ++k) {
    const FacetPlane& p = planes_[k->second];
    if (std::abs(p.normal.dot(plane.normal)) > 1 - kRounding && shell.in(p, triangle))
      number = std::min(number, k->second);
  }
  if (number < planes_.size()) return number;
  plane.e = plane.normal.unitOrthogonal();
  plane.f = plane.normal.cross(plane.e);
  by_offset_.emplace(off, number);
  planes_.push_back(std::move(plane));
  return number;
}

/// The connected triangles in the plane that face the same way as `seed`, merged greedily into convex pieces.
void Facets::add_region(Shell& shell, std::uint32_t seed, std::uint32_t number) {
  FacetPlane& plane = planes_[number];
  const bool flipped = plane.normal.dot(shell.normal(seed)) < 0;
  std::map<std::uint32_t, Loop> pieces;             // by the first triangle of each
  std::map<std::uint32_t, std::uint32_t> piece_of;  // disjoint sets: a triangle, and another of its piece
  std::vector<Edge> inner;
  std::vector<std::uint32_t> region;
  const auto take = [&](std::uint32_t t) {
    if (shell.taken[t] || !(shell.twice[t] > 0) || !shell.in(plane, t)) return;
    Loop loop(shell.triangles[t].begin(), shell.triangles[t].end());
    if (flipped) std::reverse(loop.begin(), loop.end());
    for (const std::uint32_t v : loop) shell.flat[v] = plane.flat(shell.at[v]);
    if (!(cross(shell.flat[loop[1]] - shell.flat[loop[0]], shell.flat[loop[2]] - shell.flat[loop[0]]) > 0)) return;
    shell.taken[t] = true;
    plane.area += 0.5 * shell.twice[t];
    piece_of[t] = t;
    pieces[t] = std::move(loop);
    region.push_back(t);
  };
  take(seed);
  for (std::size_t k = 0; k < region.size(); ++k) {
    const Loop loop = pieces[region[k]];
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge edge(loop[i], loop[(i + 1) % 3]), back(edge.second, edge.first);
      const auto next = shell.across.find(flipped ? edge : back);
      if (next == shell.across.end()) continue;
      take(next->second);
      if (edge.first < edge.second) inner.push_back(edge);
    }
  }
  for (const auto& [u, v] : inner) {
    const auto whose = [&](const Edge& edge) {
      auto k = piece_of.find(shell.across.find(edge)->second);
      while (k != piece_of.end() && k->second != k->first) k = piece_of.find(k->second);
      return k;
    };
    const auto a = whose(flipped ? Edge(v, u) : Edge(u, v)), b = whose(flipped ? Edge(u, v) : Edge(v, u));
    if (a == piece_of.end() || b == piece_of.end() || a == b) continue;
    Loop whole = joined(pieces[a->first], pieces[b->first], u, v, shell.flat);
    if (whole.empty()) continue;
    pieces[a->first] = std::move(whole);
    pieces.erase(b->first);
    b->second = a->first;
  }
  for (const auto& [first, loop] : pieces) {
    Facet facet;
    facet.plane = number;
    for (const std::uint32_t v : loop) {
      facet.outline.push_back(shell.flat[v]);
      facet.box.extend(shell.at[v]);
    }
    facet.flat = flat_box(facet.outline);
    plane.facets.push_back(static_cast<std::uint32_t>(facets_.size()));
    facets_.push_back(std::move(facet));
  }
}

std::vector<Vec3> Facets::directions(std::size_t most, double share) const {
  std::vector<std::pair<double, Vec3>> faces;
  double all = 0;
  for (const FacetPlane& p : planes_) {
    all += p.area;
    const auto same = std::find_if(faces.begin(), faces.end(),
                                   [&](const auto& f) { return std::abs(f.second.dot(p.normal)) > kSameDirection; });
    if (same != faces.end())
      same->first += p.area;
    else if (faces.size() < 500)  // the planes of round surfaces are many and small; this bounds the time for them
      faces.emplace_back(p.area, p.normal);
  }
  std::stable_sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Vec3> normals;
  for (const auto& [area, normal] : faces)
    if (normals.size() < most && area > share * all) normals.push_back(normal);
  return normals;
}

}  // namespace dismantle::immobility
