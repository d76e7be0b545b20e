#include "blocking/polyhedron.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;

using Limits = std::numeric_limits<double>;
using geometry::kRounding;

/// Are two unit vectors equal up to rounding? Such faces are merged and such edges joined. The limit is this strict
/// because the bends of a nearly flat surface would add up.
bool continues(const Vec3& a, const Vec3& b) { return a.dot(b) > 1 - kRounding; }

struct Adjacent {
  std::uint32_t face;
  Vec3 from, to;
};

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Displacement of a corner that moves all its planes inwards by `inset`, or nearly so where there are more than three.
Vec3 inward(const std::vector<Vec3>& normals, double inset) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(normals.size()), 3);
  for (std::size_t k = 0; k < normals.size(); ++k) rows.row(static_cast<Eigen::Index>(k)) = normals[k].transpose();
  Vec3 move = rows.completeOrthogonalDecomposition().solve(
      Eigen::VectorXd::Constant(static_cast<Eigen::Index>(normals.size()), -inset));
  if (!(move.norm() < 4 * inset)) move = 4 * inset * move.normalized();
  return move;
}

double cross2(double ax, double ay, double bx, double by) { return ax * by - ay * bx; }

/// Is `p`, a point in the plane of the face, inside the face or within `tolerance` of its boundary?
bool in_face(const Polyhedron& body, const Polyhedron::Face& face, const Vec3& p, double tolerance) {
  int axis = 0;
  face.normal.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  bool inside = false;
  for (const std::size_t e : face.edges) {
    const auto& [a, b] = body.edges()[e];
    const Vec3 ab = b - a, ap = p - a;
    const double s = std::clamp(ap.dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    if ((ap - s * ab).squaredNorm() <= tolerance * tolerance) return true;
    if ((a[v] > p[v]) != (b[v] > p[v]) && p[u] < a[u] + (p[v] - a[v]) * ab[u] / ab[v]) inside = !inside;
  }
  return inside;
}

/// Lowers `best` to the first distance along d at which a corner meets a face of `target` from outside. Seen along d, a
/// corner that meets a face is in the box of its boundary, so most pairs are not looked at.
void corners_to_faces(const std::vector<Vec3>& corners, const Vec3& offset, const Vec3& d, const Polyhedron& target,
                      double tolerance, double& best) {
  const Vec3 u = d.unitOrthogonal(), v = d.cross(u);
  struct Flat {
    double x, y;
    const Vec3* corner;
  };
  std::vector<Flat> flat;
  flat.reserve(corners.size());
  double size = 0;
  for (const Vec3& c : corners) {
    const Vec3 p = c + offset;
    flat.push_back({p.dot(u), p.dot(v), &c});
    size = std::max(size, p.cwiseAbs().sum());
  }
  std::sort(flat.begin(), flat.end(), [](const Flat& p, const Flat& q) { return p.x < q.x; });
  for (const auto& face : target.faces()) {
    const double rate = face.normal.dot(d);
    if (rate > -kRounding) continue;
    double x0 = Limits::infinity(), x1 = -x0, y0 = x0, y1 = x1, off = 0;  // `off`: of the boundary from the plane
    for (const std::size_t e : face.edges)
      for (const Vec3* p : {&target.edges()[e].a, &target.edges()[e].b}) {
        const double x = p->dot(u), y = p->dot(v);
        x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
        off = std::max(off, std::abs(face.normal.dot(*p) - face.offset));
        size = std::max(size, p->cwiseAbs().sum());
      }
    const double margin = tolerance + 2 * off + kRounding * size;
    const auto left = [&](const Flat& c) { return c.x < x0 - margin; };
    for (auto c = std::partition_point(flat.begin(), flat.end(), left); c != flat.end() && c->x <= x1 + margin; ++c) {
      if (c->y < y0 - margin || c->y > y1 + margin) continue;
      const Vec3 p = *c->corner + offset;
      const double t = (face.offset - face.normal.dot(p)) / rate;
      if (t < 0 || t >= best) continue;
      if (in_face(target, face, p + t * d, tolerance)) best = t;
    }
  }
}

void edges_to_edges(const Polyhedron& a, const Polyhedron& b, const Vec3& offset, const Vec3& d, double tolerance,
                    double& best) {
  // Two edges meet where their projections along d cross. Their depths at the crossing give the distance until then.
  const Vec3 u = d.unitOrthogonal(), v = d.cross(u);
  struct Flat {
    double x, y, z, dx, dy, dz, length, x0, x1, y0, y1;
  };
  const auto flatten = [&](const Polyhedron& body, const Vec3& by) {
    std::vector<Flat> out;
    out.reserve(body.edges().size());
    for (const auto& e : body.edges()) {
      const Vec3 p = e.a + by, w = e.b - e.a;
      const double dx = w.dot(u), dy = w.dot(v), x = p.dot(u), y = p.dot(v);
      const double length = std::hypot(dx, dy);
      if (length > kRounding)
        out.push_back({x, y, p.dot(d), dx, dy, w.dot(d), length, std::min(x, x + dx), std::max(x, x + dx),
                       std::min(y, y + dy), std::max(y, y + dy)});
    }
    return out;
  };
  const std::vector<Flat> ours = flatten(a, offset);
  std::vector<Flat> theirs = flatten(b, Vec3::Zero());
  std::sort(theirs.begin(), theirs.end(), [](const Flat& p, const Flat& q) { return p.x0 < q.x0; });
  double widest = 0;
  for (const Flat& f : theirs) widest = std::max(widest, f.x1 - f.x0);
  for (const Flat& e : ours) {
    const double ex0 = e.x0 - tolerance, ex1 = e.x1 + tolerance, ey0 = e.y0 - tolerance, ey1 = e.y1 + tolerance;
    const double first = ex0 - widest - kRounding * (std::abs(ex0) + widest);
    const auto left = [&](const Flat& f) { return f.x0 < first; };
    for (auto at = std::partition_point(theirs.begin(), theirs.end(), left); at != theirs.end() && at->x0 <= ex1;
         ++at) {
      const Flat& f = *at;
      if (f.x1 < ex0 || f.y0 > ey1 || f.y1 < ey0) continue;
      const double det = cross2(e.dx, e.dy, f.dx, f.dy);
      if (std::abs(det) < kRounding * e.length * f.length) continue;  // parallel: corners_to_faces() covers these
      const double s = cross2(f.x - e.x, f.y - e.y, f.dx, f.dy) / det;
      const double q = cross2(f.x - e.x, f.y - e.y, e.dx, e.dy) / det;
      if (s < -tolerance / e.length || s > 1 + tolerance / e.length || q < -tolerance / f.length ||
          q > 1 + tolerance / f.length)
        continue;
      const double t = (f.z + q * f.dz) - (e.z + s * e.dz);
      if (t >= 0 && t < best) best = t;
    }
  }
}

}  // namespace

Polyhedron::Polyhedron(const Mesh& mesh, double inset) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<Vec3> normals(count);
  std::vector<std::uint32_t> parent(count);
  std::iota(parent.begin(), parent.end(), 0U);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> by_edge;
  for (std::uint32_t t = 0; t < count; ++t) {
    normals[t] = geometry::area_vector(mesh, t).normalized();
    for (std::size_t k = 0; k < 3; ++k) by_edge[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}] = t;
  }
  const auto neighbour = [&](std::uint32_t from, std::uint32_t to) {
    const auto found = by_edge.find({to, from});
    return found == by_edge.end() ? count : found->second;
  };
  for (std::uint32_t t = 0; t < count; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t n = neighbour(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      if (n == count || !continues(normals[t], normals[n])) continue;
      parent[root_of(parent, t)] = root_of(parent, n);
    }

  // Move each corner inwards with the planes that meet there.
  std::vector<std::vector<Vec3>> planes(mesh.vertices.size());
  for (std::uint32_t t = 0; t < count; ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (std::none_of(planes[v].begin(), planes[v].end(), [&](const Vec3& n) { return continues(n, normals[t]); }))
        planes[v].push_back(normals[t]);
  std::vector<Vec3> moved = mesh.vertices;
  for (std::size_t v = 0; v < moved.size(); ++v)
    if (!planes[v].empty()) moved[v] += inward(planes[v], inset);

  // Edges between faces. Collinear edges of the same two faces that meet end to end are merged.
  struct Piece {
    std::uint32_t from, to;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Piece>> between;
  for (const auto& [ends, t] : by_edge) {
    const std::uint32_t n = neighbour(ends.first, ends.second);
    if (n == count || ends.first > ends.second) continue;
    const std::uint32_t f = root_of(parent, t), g = root_of(parent, n);
    if (f != g) between[std::minmax(f, g)].push_back({ends.first, ends.second});
  }
  std::map<std::uint32_t, std::size_t> index;
  const auto face_at = [&](std::uint32_t root) -> Face& {
    const auto [entry, is_new] = index.try_emplace(root, faces_.size());
    if (is_new) {
      faces_.emplace_back();
      faces_.back().normal = normals[root];
      faces_.back().offset = normals[root].dot(mesh.vertex(root, 0)) - inset;
    }
    return faces_[entry->second];
  };
  std::vector<bool> is_corner(moved.size(), false);
  for (auto& [pair, pieces] : between) {
    const Vec3 along = (mesh.vertices[pieces[0].to] - mesh.vertices[pieces[0].from]).normalized();
    const auto at = [&](std::uint32_t v) { return along.dot(mesh.vertices[v]); };
    for (auto& p : pieces)
      if (at(p.from) > at(p.to)) std::swap(p.from, p.to);
    std::sort(pieces.begin(), pieces.end(), [&](const Piece& a, const Piece& b) { return at(a.from) < at(b.from); });
    std::vector<Piece> merged;
    for (const Piece& p : pieces) {
      const bool goes_on = !merged.empty() && merged.back().to == p.from &&
                           continues((mesh.vertices[p.to] - mesh.vertices[p.from]).normalized(), along) &&
                           planes[p.from].size() <= 2;
      if (goes_on)
        merged.back().to = p.to;
      else
        merged.push_back(p);
    }
    for (const Piece& p : merged) {
      is_corner[p.from] = is_corner[p.to] = true;
      const std::size_t e = edges_.size();
      edges_.push_back({moved[p.from], moved[p.to]});
      face_at(pair.first).edges.push_back(e);
      face_at(pair.second).edges.push_back(e);
    }
  }
  for (std::size_t v = 0; v < moved.size(); ++v)
    if (is_corner[v]) corners_.push_back(moved[v]);
  for (const Vec3& c : corners_) box_.extend(c);
}

double distance_until_contact(const Polyhedron& a, const Polyhedron& b, const Vec3& offset, const Vec3& d,
                              double tolerance) {
  // Boxes first: the bodies never meet if the boxes are apart across d, or if `a` is already past `b`.
  double past = Limits::infinity();
  for (int k = 0; k < 3; ++k) {
    const double lo = a.box().lo[k] + offset[k], hi = a.box().hi[k] + offset[k];
    if (d[k] > kRounding)
      past = std::min(past, (b.box().hi[k] + tolerance - lo) / d[k]);
    else if (d[k] < -kRounding)
      past = std::min(past, (b.box().lo[k] - tolerance - hi) / d[k]);
    else if (lo > b.box().hi[k] + tolerance || hi < b.box().lo[k] - tolerance)
      return Limits::infinity();
  }
  if (past < 0) return Limits::infinity();
  double best = Limits::infinity();
  corners_to_faces(a.corners(), offset, d, b, tolerance, best);
  corners_to_faces(b.corners(), -offset, -d, a, tolerance, best);
  edges_to_edges(a, b, offset, d, tolerance, best);
  return best;
}

}  // namespace dismantle::blocking
