#include "dismantle/statics/contacts.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "bonds.h"
#include "polygon.h"
#include "shape.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Corners = std::array<Vec3, 3>;

constexpr double kFacing = 0.94;       // cosine of 20 degrees: facets of two tessellations of one curved surface
constexpr double kSamePlane = 0.9999;  // cosine of 0.8 degrees
constexpr double kLean = 0.02;         // cosine: facets of a cylinder; a Morse taper leans by more
constexpr double kStrip = 1e-6;        // of the gap: narrower strips of contact come from rounding
constexpr std::size_t kCorners = 16, kSpread = 32;

/// A region where two facets touch. Frame of the world.
struct Facet {
  Polygon polygon;
  Vec3 normal;  // out of b
  double area;
};

/// Facets of one plane.
struct Plane {
  Vec3 normal, at;
  double area = 0;
  std::vector<Vec3> points;
};

double perimeter(const Polygon& p) {
  double around = 0;
  for (std::size_t i = 0; i < p.size(); ++i) around += (p[(i + 1) % p.size()] - p[i]).norm();
  return around;
}

/// The common regions of facing triangles, in the middle between them.
class Clipper {
 public:
  std::optional<Facet> common(const Corners& a, const Vec3& na, const Corners& b, const Vec3& nb, double gap) {
    const Vec3 m = (nb - na).normalized();
    // The height of a above b along m is linear: (p - b0) . nb / (m . nb).
    const Vec3 height = nb / m.dot(nb);
    const double zero = height.dot(b[0]);
    if (all_of(a, [&](const Vec3& p) { return height.dot(p) - zero > gap; })) return std::nullopt;
    if (all_of(a, [&](const Vec3& p) { return height.dot(p) - zero < -gap; })) return std::nullopt;
    Corners out;  // of each edge of b, in the projection along m
    for (std::size_t i = 0; i < 3; ++i) {
      out[i] = (b[(i + 1) % 3] - b[i]).cross(m);
      if (out[i].norm() == 0) return std::nullopt;
      out[i].normalize();
      if (all_of(a, [&](const Vec3& p) { return out[i].dot(p) > out[i].dot(b[i]); })) return std::nullopt;
    }
    region_.assign(a.begin(), a.end());
    for (std::size_t i = 0; i < 3; ++i) keep(out[i], out[i].dot(b[i]));
    keep(height, zero + gap);
    keep(-height, gap - zero);
    if (region_.size() < 3) return std::nullopt;
    const double area = area_of(region_).norm();
    if (!(area > 0.5 * kStrip * gap * perimeter(region_))) return std::nullopt;
    for (Vec3& p : region_) p -= 0.5 * (height.dot(p) - zero) * m;
    return Facet{region_, m, area};
  }

 private:
  template <class Test>
  static bool all_of(const Corners& corners, const Test& test) {
    return std::all_of(corners.begin(), corners.end(), test);
  }

  void keep(const Vec3& normal, double limit) {
    clip(region_, normal, limit, kept_);
    region_.swap(kept_);
  }

  Polygon region_, kept_;
};

std::vector<Facet> facets_between(const PlacedShape& a, const PlacedShape& b, double gap) {
  std::vector<Facet> facets;
  Clipper clipper;
  const Shape::Data &da = a.shape->data(), &db = b.shape->data();
  const Pose to_b = b.pose.inverse() * a.pose;
  Aabb reach = db.mesh.box();
  reach.inflate(gap);
  for (std::uint32_t t = 0; t < da.mesh.triangles.size(); ++t) {
    if (da.normals[t].isZero()) continue;
    const Corners ta = {to_b * da.mesh.vertex(t, 0), to_b * da.mesh.vertex(t, 1), to_b * da.mesh.vertex(t, 2)};
    Aabb box;
    for (const Vec3& v : ta) box.extend(v);
    box.inflate(gap);
    if (!box.overlaps(reach)) continue;
    const Vec3 na = to_b.q * da.normals[t];
    db.bvh.overlapping(box, [&](std::uint32_t other) {
      const Vec3& nb = db.normals[other];
      if (!(na.dot(nb) < -kFacing)) return;
      auto facet = clipper.common(ta, na, db.bvh.corners(other), nb, gap);
      if (!facet) return;
      for (Vec3& p : facet->polygon) p = b.pose * p;
      facet->normal = b.pose.q * facet->normal;
      facets.push_back(std::move(*facet));
    });
  }
  return facets;
}

std::vector<Plane> planes_of(std::vector<Facet> facets, double gap) {
  std::sort(facets.begin(), facets.end(), [](const Facet& x, const Facet& y) { return x.area > y.area; });
  std::vector<Plane> planes;
  for (const Facet& f : facets) {
    Plane* plane = nullptr;
    for (Plane& p : planes) {
      if (p.normal.dot(f.normal) < kSamePlane) continue;
      double off = 0;
      for (const Vec3& v : f.polygon) off = std::max(off, std::abs(p.normal.dot(v - p.at)));
      if (off <= gap) {
        plane = &p;
        break;
      }
    }
    if (plane == nullptr) {
      planes.push_back({f.normal, f.polygon.front(), 0, {}});
      plane = &planes.back();
    }
    plane->area += f.area;
    plane->points.insert(plane->points.end(), f.polygon.begin(), f.polygon.end());
  }
  return planes;
}

struct Spread {
  Vec3 at, normal;
};

/// Points far apart from each other, in place and in direction.
std::vector<Spread> far_apart(const std::vector<Spread>& all, double size, std::size_t most) {
  std::vector<Spread> chosen;
  std::vector<double> distance(all.size(), std::numeric_limits<double>::infinity());
  Vec3 center = Vec3::Zero();
  for (const Spread& s : all) center += s.at / static_cast<double>(all.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    if ((all[i].at - center).squaredNorm() > (all[next].at - center).squaredNorm()) next = i;
  while (chosen.size() < std::min(most, all.size())) {
    chosen.push_back(all[next]);
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double d = (all[i].at - chosen.back().at).squaredNorm() +
                       size * size * (all[i].normal - chosen.back().normal).squaredNorm();
      distance[i] = std::min(distance[i], d);
      if (distance[i] > distance[farthest]) farthest = i;
    }
    if (!(distance[farthest] > 1e-6 * size * size)) break;
    next = farthest;
  }
  return chosen;
}

/// True if the surface of `b` around a point is flat: the point is no rim of it.
bool inside_face(const Shape::Data& b, const Vec3& at, const Vec3& normal, double margin) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  for (int k = 0; k < 8; ++k) {
    const double angle = k * 0.7853981633974483;
    const Vec3 p = at + margin * (std::cos(angle) * u + std::sin(angle) * v);
    const ClosestPoint c = b.bvh.closest(p, margin);
    if (c.triangle == 0xffffffffu || c.distance > 0.3 * margin || b.normals[c.triangle].dot(normal) < kFacing)
      return false;
  }
  return true;
}

/// Edges and corners of a on faces of b. Frame of b; `planes` get contacts with the normal out of b times `sign`.
void add_edges(const PlacedShape& a, const PlacedShape& b, double gap, double sign, std::vector<Plane>& planes) {
  const Shape::Data &da = a.shape->data(), &db = b.shape->data();
  const Pose to_b = b.pose.inverse() * a.pose;
  Aabb reach = db.mesh.box();
  reach.inflate(gap);
  const std::size_t faces = planes.size();
  const auto add = [&](const Vec3& at, const Vec3& normal) {
    const Vec3 p = b.pose * at, n = sign * (b.pose.q * normal);
    for (std::size_t k = 0; k < planes.size(); ++k) {
      Plane& plane = planes[k];
      if (plane.normal.dot(n) < (k < faces ? kFacing : kSamePlane) ||
          std::abs(plane.normal.dot(p - plane.at)) > 4 * gap)
        continue;
      if (k >= faces) plane.points.push_back(p);
      return;  // a face is there already
    }
    planes.push_back({n, p, 0, {p}});
  };
  for (const Tip& tip : da.tips) {
    const Vec3 at = to_b * tip.at;
    if (!reach.contains(at)) continue;
    const ClosestPoint c = db.bvh.closest(at, gap);
    if (c.triangle == 0xffffffffu || db.normals[c.triangle].isZero()) continue;
    const Vec3& n = db.normals[c.triangle];
    const bool above = std::all_of(tip.directions.begin(), tip.directions.end(),
                                   [&](const Vec3& direction) { return (to_b.q * direction).dot(n) > -1e-3; });
    if (above && inside_face(db, c.point, n, 4 * gap)) add(c.point, n);
  }
  for (const Ridge& r : da.ridges) {
    const Vec3 p = to_b * r.from, q = to_b * r.to, left = to_b.q * r.left, right = to_b.q * r.right;
    Aabb box;
    box.extend(p);
    box.extend(q);
    box.inflate(gap);
    if (!box.overlaps(reach)) continue;
    db.bvh.overlapping(box, [&](std::uint32_t t) {
      const Vec3& n = db.normals[t];
      const auto& c = db.bvh.corners(t);
      if (std::abs(n.dot(p - c[0])) > gap || std::abs(n.dot(q - c[0])) > gap) return;
      if (n.isZero()) return;
      // The solid lies above the face: minus its normal is between those of the faces beside the edge.
      const Vec3 along = (q - p).normalized();
      if (left.cross(-n).dot(along) * (-n).cross(right).dot(along) <= 0 || (left + right).dot(n) >= 0) return;
      double from = 0, to = 1;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 out = (c[(i + 1) % 3] - c[i]).cross(n);
        const double dp = out.dot(p - c[i]), dq = out.dot(q - c[i]);
        if (dp > 0 && dq > 0) return;
        if (dp > 0) from = std::max(from, dp / (dp - dq));
        if (dq > 0) to = std::min(to, dp / (dp - dq));
      }
      if (!((to - from) * (q - p).norm() > gap) || !inside_face(db, p + 0.5 * (from + to) * (q - p), n, 4 * gap))
        return;
      add(p + from * (q - p), n);
      add(p + to * (q - p), n);
    });
  }
}

/// Along a cylinder, if the planes are facets of one: the triangles between its two circles lean by up to their sagitta
/// over its height, to either side. In a taper all lean to one side.
std::optional<Vec3> cylinder_axis(const std::vector<Plane>& planes) {
  constexpr std::size_t kFacets = 8, kLargest = 12;
  if (planes.size() < kFacets) return std::nullopt;
  const auto along = [&](const Vec3& axis, const auto& use) {
    for (const Plane& p : planes)
      if (std::abs(p.normal.dot(axis)) < kLean) use(p);
  };
  Vec3 best = Vec3::Zero();
  double most = 0;
  for (std::size_t i = 0; i < std::min(kLargest, planes.size()); ++i)  // the largest are first
    for (std::size_t k = 0; k < i; ++k) {
      const Vec3 across = planes[i].normal.cross(planes[k].normal);
      if (across.norm() < 0.1) continue;
      double area = 0;
      along(across.normalized(), [&](const Plane& p) { area += p.area; });
      if (area > most) best = across.normalized();
      most = std::max(most, area);
    }
  if (most == 0) return std::nullopt;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  along(best, [&](const Plane& p) { spread += p.area * p.normal * p.normal.transpose(); });
  const Vec3 axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  std::size_t facets = 0;
  double lean = 0, largest = 0;
  along(axis, [&](const Plane& p) {
    ++facets;
    lean += p.area * p.normal.dot(axis) / most;
    largest = std::max(largest, std::abs(p.normal.dot(axis)));
  });
  if (facets < kFacets || std::abs(lean) > 0.5 * largest) return std::nullopt;
  return axis;
}

/// Facets of a cylinder as they are on it: what is in a bore does not stand in it as on a slope.
void make_upright(std::vector<Plane>& planes) {
  const std::optional<Vec3> axis = cylinder_axis(planes);
  if (!axis) return;
  for (Plane& p : planes)
    if (const double lean = p.normal.dot(*axis); std::abs(lean) < kLean)
      p.normal = (p.normal - lean * *axis).normalized();
}

/// The planes that count, and points spread over curved surfaces.
std::vector<Contact> contacts_of(const std::vector<Plane>& planes, double gap, double size, bool rims) {
  std::vector<Contact> contacts;
  double all = 0;
  for (const Plane& p : planes) all += p.area;
  std::vector<Spread> curved;
  for (const Plane& p : planes) {
    const Polygon hull = hull_in_plane(p.points, p.normal, kCorners);
    if (p.area > 0 && !rims && area_of(hull).norm() < 0.25 * gap * perimeter(hull))
      continue;  // thinner than the gap: a rim
    if (p.area == 0 || p.area > 0.08 * all || planes.size() <= 12)
      contacts.push_back({0, 0, p.normal, hull});
    else
      for (const Vec3& at : hull) curved.push_back({at, p.normal});
  }
  for (const Spread& s : far_apart(curved, size, kSpread)) contacts.push_back({0, 0, s.normal, {s.at}});
  return contacts;
}

std::vector<Contact> found_between(const PlacedShape& a, const PlacedShape& b, double touching, bool rims) {
  const double size = std::min(a.shape->radius(), b.shape->radius()), gap = touching * size;
  const Vec3 apart = a.pose * a.shape->center() - b.pose * b.shape->center();
  if (apart.norm() > a.shape->radius() + b.shape->radius() + gap) return {};
  // Iterate over the triangles of the part that has fewer.
  if (a.shape->mesh().triangles.size() > b.shape->mesh().triangles.size()) {
    std::vector<Contact> contacts = found_between(b, a, touching, rims);
    for (Contact& c : contacts) c.normal = -c.normal;
    return contacts;
  }
  std::vector<Plane> planes = planes_of(facets_between(a, b, gap), gap);
  make_upright(planes);
  add_edges(a, b, gap, 1, planes);
  add_edges(b, a, gap, -1, planes);
  return contacts_of(planes, gap, size, rims);
}

}  // namespace

std::vector<Contact> contacts_between(const PlacedShape& a, const PlacedShape& b, double touching) {
  return found_between(a, b, touching, false);
}

std::vector<Contact> contacts_with_rims(const PlacedShape& a, const PlacedShape& b, double touching) {
  return found_between(a, b, touching, true);
}

Contact contact_with_table(const PlacedShape& part, const Vec3& up, double height, double touching) {
  const double gap = touching * part.shape->radius();
  std::vector<Vec3> points;
  for (const Vec3& v : part.shape->mesh().vertices) {
    const Vec3 p = part.pose * v;
    if (up.dot(p) - height <= gap) points.push_back(p);
  }
  return {0, 0, up, hull_in_plane(points, up, kCorners)};
}

}  // namespace dismantle::statics
