#include "dismantle/geometry/solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "dismantle/geometry/disjoint_sets.h"
#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/mesh_edges.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/ray.h"
#include "solid/pinches.h"

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;

/// The triangles of `pick` and the vertices they use, in the order of the mesh.
Mesh sub_mesh(const Mesh& mesh, const std::vector<std::uint32_t>& pick, bool flip = false) {
  Mesh out;
  std::vector<std::uint32_t> used;
  for (const auto t : pick) used.insert(used.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  std::vector<std::uint32_t> number;  // by vertex; not needed for a small shell of a large mesh
  if (used.size() >= mesh.vertices.size()) {
    number.assign(mesh.vertices.size(), kNoIndex);
    for (const auto v : used) number[v] = 0;
    used.clear();
    for (std::uint32_t v = 0; v < number.size(); ++v) {
      if (number[v] == kNoIndex) continue;
      number[v] = static_cast<std::uint32_t>(used.size());
      used.push_back(v);
    }
  } else {
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
  }
  out.vertices.reserve(used.size());
  for (const auto v : used) out.vertices.push_back(mesh.vertices[v]);
  const auto renumbered = [&](std::uint32_t v) {
    if (!number.empty()) return number[v];
    return static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  };
  out.triangles.reserve(pick.size());
  for (const auto t : pick) {
    Triangle r{renumbered(mesh.triangles[t][0]), renumbered(mesh.triangles[t][1]), renumbered(mesh.triangles[t][2])};
    if (flip) std::swap(r[1], r[2]);
    out.triangles.push_back(r);
  }
  return out;
}

void append(Mesh& to, const Mesh& from) {
  const auto base = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  for (const auto& t : from.triangles) to.triangles.push_back({base + t[0], base + t[1], base + t[2]});
}

Vec3 triangle_normal(const Mesh& mesh, std::size_t t) {
  const Vec3 a = mesh.vertex(t, 0), ab = mesh.vertex(t, 1) - a, ac = mesh.vertex(t, 2) - a;
  const Vec3 n = ab.cross(ac);
  const double length = n.norm();
  const double longest = std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()}));
  const double size = std::max(a.cwiseAbs().maxCoeff(), longest);
  if (!(length > 1e-8 * size * longest)) return Vec3::Zero();  // its height is below the rounding of its corners
  return n / length;
}

/// Direction that enters all faces with these outward normals as steeply as possible (centre of their smallest
/// spherical cap, by Badoiu and Clarkson's iteration), or zero.
Vec3 inward_direction(const std::vector<Vec3>& normals) {
  Vec3 c = Vec3::Zero();
  for (const auto& n : normals) c += n;
  c /= static_cast<double>(normals.size());
  const auto steepness = [&](const Vec3& d) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& n : normals) least = std::min(least, n.dot(d));
    return least;
  };
  Vec3 best = c.norm() > 1e-9 ? Vec3(c.normalized()) : normals.front();
  double best_sine = steepness(best);
  for (int k = 1; k <= 48 && best_sine < 1 - 1e-9; ++k) {
    const Vec3* far = &normals.front();
    for (const auto& n : normals)
      if ((n - c).squaredNorm() > (*far - c).squaredNorm()) far = &n;
    c += (*far - c) / (k + 1.0);
    if (c.norm() < 1e-9) continue;
    const Vec3 d = c.normalized();
    const double sine = steepness(d);
    if (sine > best_sine) {
      best_sine = sine;
      best = d;
    }
  }
  // A direction that enters a face at less than 3 degrees (sine 0.05) moves far sideways before it gets deep.
  return best_sine < 0.05 ? Vec3(Vec3::Zero()) : Vec3(-best);
}

std::vector<Vec3> inward_directions(const Mesh& mesh, const std::vector<Vec3>& normals, const Poll& poll) {
  std::vector<std::vector<Vec3>> around(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    poll.in_pass(t);
    if (normals[t].isZero(0)) continue;
    for (const auto v : mesh.triangles[t]) {
      auto& list = around[v];
      if (std::none_of(list.begin(), list.end(), [&](const Vec3& n) { return (n - normals[t]).squaredNorm() < 1e-20; }))
        list.push_back(normals[t]);
    }
  }
  std::vector<Vec3> directions(mesh.vertices.size(), Vec3::Zero());
  for (std::size_t v = 0; v < directions.size(); ++v) {
    poll.in_pass(v);
    if (!around[v].empty()) directions[v] = inward_direction(around[v]);
  }
  return directions;
}

/// Axes along the two perpendicular directions that most of the surface faces.
Pose tight_frame(const Mesh& mesh) {
  using geometry::FaceAxis;
  std::vector<FaceAxis> all;
  all.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (const Vec3 n = triangle_normal(mesh, t); !n.isZero(0))
      all.push_back({n, 0.5 * geometry::area_vector(mesh, t).norm()});
  const std::vector<FaceAxis> sums = geometry::rounded_axes(all);
  const auto largest = [&](const auto& fits) {
    const FaceAxis* best = nullptr;
    for (const auto& f : sums)
      if (fits(f) && (!best || f.area > best->area)) best = &f;
    return best;
  };
  const FaceAxis* first = largest([](const FaceAxis&) { return true; });
  if (!first) return {};
  const FaceAxis* second = largest([&](const FaceAxis& f) { return std::abs(f.axis.dot(first->axis)) < 0.02; });
  const Vec3 x = first->axis;
  const Vec3 y = second ? Vec3((second->axis - second->axis.dot(x) * x).normalized()) : x.unitOrthogonal();
  Eigen::Matrix3d r;
  r << x, y, x.cross(y);
  // Already along the axes: leave the coordinates as they are.
  if ((r.cwiseAbs().rowwise().maxCoeff().array() > 1 - 1e-9).all()) return {};
  return {Vec3::Zero(), Eigen::Quaterniond(r).normalized()};
}

Mesh turned(const Mesh& mesh, const Pose& frame) {
  Mesh local = mesh;
  if (frame.is_identity()) return local;
  const Eigen::Matrix3d back = frame.q.toRotationMatrix().transpose();
  for (auto& v : local.vertices) v = back * v;
  return local;
}

/// The same triangles, connected only across edges that join exactly two of them in the same sense. So every piece is
/// a manifold with two sides, and no vertex lies where it touches itself.
Mesh cut_into_sheets(const Mesh& mesh) {
  // Corners of triangles that are the same vertex of a sheet.
  DisjointSets sets(3 * mesh.triangles.size());
  const auto corner = [](std::uint32_t triangle, std::uint32_t k) { return 3 * triangle + k % 3; };
  mesh_detail::for_each_edge(mesh_detail::sorted_edges(mesh), [&](const auto* first, const auto* last) {
    if (last - first != 2 || first->forward == first[1].forward) return;
    sets.join(corner(first->triangle, first->corner), corner(first[1].triangle, first[1].corner + 1U));
    sets.join(corner(first->triangle, first->corner + 1U), corner(first[1].triangle, first[1].corner));
  });
  Mesh cut;
  std::vector<std::uint32_t> number(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle made{};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t at = corner(t, k), root = sets.root(at);  // root <= at
      if (root == at) {
        number[at] = static_cast<std::uint32_t>(cut.vertices.size());
        cut.vertices.push_back(mesh.vertices[mesh.triangles[t][k]]);
      }
      made[k] = number[root];
    }
    cut.triangles.push_back(made);
  }
  return cut;
}

bool share_corner(const Triangle& a, const Triangle& b) {
  for (const auto i : a)
    for (const auto j : b)
      if (i == j) return true;
  return false;
}

/// Distance to the opposite side, where the solid ends. Where a surface touches itself with nothing but solid on both
/// sides (a thread tooth that ends on the underside of its head), the solid goes on. A face that is folded within its
/// plane has triangles that face into the solid: their rays say nothing, those of the layers that face outward do.
/// Infinite: not within reach.
template <class Blocks>
double wall_behind(const TriangleBvh& bvh, const Vec3& from, const Vec3& into, double reach, const Blocks& blocks) {
  const double beyond = 1e-3 * reach;  // of a gap that counts as none: 0.4 % of the tolerance
  for (double at = 0; at < reach;) {
    at += first_hit(bvh, from + at * into, into, reach - at, blocks);
    if (!(at < reach)) break;
    if (!bvh.inside(from + (at + beyond) * into)) {
      if (at < beyond && bvh.inside(from - beyond * into)) break;
      return at;
    }
    at += beyond;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

Solid::Solid(const Mesh& m, const Poll& poll, Surface surface)
    : frame(tight_frame(m)),
      mesh(surface == Surface::open ? turned(m, frame) : without_pinches(turned(m, frame))),
      bvh(mesh, poll, surface),
      box(mesh.box()),
      open(surface == Surface::open) {
  normals.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < normals.size(); ++t) normals[t] = triangle_normal(mesh, t);
  poll.before(mesh.triangles.size());
  inward = inward_directions(mesh, normals, poll);
  poll.before(mesh.triangles.size());
  thickness.assign(mesh.triangles.size(), std::numeric_limits<double>::infinity());
  vertex_thickness.assign(mesh.vertices.size(), std::numeric_limits<double>::infinity());

  std::size_t shells = 0;
  shell_of = shells_of(mesh, shells);
  std::vector<std::vector<std::uint32_t>> vertices(shells);
  for (std::size_t t = 0; t < shell_of.size(); ++t)
    vertices[shell_of[t]].insert(vertices[shell_of[t]].end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  shell_begin.push_back(0);
  for (auto& list : vertices) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    shell_vertices.insert(shell_vertices.end(), list.begin(), list.end());
    shell_begin.push_back(static_cast<std::uint32_t>(shell_vertices.size()));
  }
}

void Solid::measure_thickness(double reach, const Poll& poll) {
  if (open) return;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    poll.in_pass(t);
    thickness[t] = std::numeric_limits<double>::infinity();
    if (normals[t].isZero(0)) continue;
    const auto blocks = [&](std::uint32_t other) {
      if (other == t) return false;
      const double facing = normals[t].dot(normals[other]);
      if (share_corner(mesh.triangles[t], mesh.triangles[other])) return facing < -0.9;  // the edge of a blade
      return facing < 0;                                                                 // an opposite side faces away
    };
    // Most triangles have no opposite side within reach: one query covers all rays of the triangle.
    Aabb around;
    for (int k = 0; k < 3; ++k) {
      around.extend(mesh.vertex(t, k));
      around.extend(Vec3(mesh.vertex(t, k) - reach * normals[t]));
    }
    bool any = false;
    bvh.overlapping(around, [&](std::uint32_t other) { any = any || blocks(other); });
    if (!any) continue;
    // Barycentric coordinates of the ray origins: the middle and near each corner.
    for (const Vec3& w :
         {Vec3(1.0 / 3, 1.0 / 3, 1.0 / 3), Vec3(0.8, 0.1, 0.1), Vec3(0.1, 0.8, 0.1), Vec3(0.1, 0.1, 0.8)}) {
      const Vec3 from = w[0] * mesh.vertex(t, 0) + w[1] * mesh.vertex(t, 1) + w[2] * mesh.vertex(t, 2);
      thickness[t] = std::min(thickness[t], wall_behind(bvh, from, -normals[t], reach, blocks));
    }
  }
  vertex_thickness.assign(mesh.vertices.size(), std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const auto v : mesh.triangles[t]) vertex_thickness[v] = std::min(vertex_thickness[v], thickness[t]);
}

std::vector<Solid> split_into_solids(const Mesh& mesh, const Poll& poll) {
  poll.before(mesh.triangles.size());
  if (!edge_use(mesh).closed()) {
    std::vector<Solid> walls;
    walls.emplace_back(cut_into_sheets(mesh), poll, Surface::open);
    return walls;
  }
  std::size_t shells = 0;
  const std::vector<std::uint32_t> shell = shells_of(mesh, shells);
  poll.before(mesh.triangles.size());
  std::vector<std::vector<std::uint32_t>> triangles(shells);
  for (std::uint32_t t = 0; t < shell.size(); ++t) triangles[shell[t]].push_back(t);

  struct Group {
    Mesh mesh;
    double volume;
  };
  std::vector<Group> groups;
  std::vector<std::uint32_t> voids;
  for (std::uint32_t s = 0; s < shells; ++s) {
    poll.before(mesh.triangles.size());
    Mesh m = sub_mesh(mesh, triangles[s]);
    const double v = signed_volume(m);
    if (v < 0)
      voids.push_back(s);
    else
      groups.push_back({std::move(m), v});
  }
  const std::size_t outer = groups.size();
  std::vector<TriangleBvh> trees;
  if (!voids.empty())
    for (const auto& g : groups) trees.emplace_back(g.mesh, poll);
  for (const auto s : voids) {
    const Mesh m = sub_mesh(mesh, triangles[s]);
    std::size_t owner = outer;
    for (std::size_t g = 0; g < outer; ++g)
      if ((owner == outer || groups[g].volume < groups[owner].volume) && trees[g].inside(m.vertices.front())) owner = g;
    if (owner < outer)
      append(groups[owner].mesh, m);
    else
      groups.push_back({sub_mesh(mesh, triangles[s], true), -signed_volume(m)});
  }
  std::vector<Solid> solids;
  solids.reserve(groups.size());
  for (const auto& g : groups) solids.emplace_back(g.mesh, poll);
  return solids;
}

}  // namespace dismantle::geometry
