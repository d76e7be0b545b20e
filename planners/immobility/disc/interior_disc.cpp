#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "disc/disc_cage.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle::immobility {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

// Share of a wall's half thickness that a disc uses. With all of it, rounding would make the wall's own faces
// obstacles.
constexpr double kWithin = 0.98;

/// The middle plane of a wall, and the centres of medial balls on it.
struct WallPlane {
  Vec3 normal;
  double offset = 0, half = 0;
  std::vector<Vec3> on;
};

std::vector<WallPlane> planes_of(const Solid& solid, const std::vector<MedialBall>& balls, double depth) {
  std::vector<WallPlane> planes;
  for (const MedialBall& ball : balls) {
    if (!(kWithin * ball.radius > depth)) break;
    const Vec3 center = solid.frame.inverse() * ball.center;
    const Vec3 normal = solid.normals[solid.bvh.closest(center).triangle];
    const auto same = [&](const WallPlane& p) {
      return std::abs(p.normal.dot(normal)) > kSameDirection &&
             std::abs(p.normal.dot(center) - p.offset) < 0.02 * p.half && ball.radius > 0.95 * p.half;
    };
    const auto known = std::find_if(planes.begin(), planes.end(), same);
    if (known == planes.end())
      planes.push_back({normal, normal.dot(center), ball.radius, {center}});
    else
      known->on.push_back(center);
  }
  std::stable_sort(planes.begin(), planes.end(),
                   [](const WallPlane& a, const WallPlane& b) { return a.on.size() > b.on.size(); });
  if (planes.size() > 12) planes.resize(12);  // those with the most balls are the largest walls
  return planes;
}

using Projection = std::vector<Vec2>;  // convex, of either orientation

/// The part of a triangle within `most` of the plane, projected to it.
Projection near_plane(const std::array<Vec3, 3>& corners, const WallPlane& plane, double most, const Vec3& e,
                      const Vec3& f) {
  std::vector<Vec3> left(corners.begin(), corners.end());
  for (const double side : {-1.0, 1.0}) {
    std::vector<Vec3> next;
    const auto out = [&](const Vec3& p) { return side * (plane.normal.dot(p) - plane.offset) - most; };
    for (std::size_t k = 0; k < left.size(); ++k) {
      const Vec3 &p = left[k], &q = left[(k + 1) % left.size()];
      const double a = out(p), b = out(q);
      if (a <= 0) next.push_back(p);
      if ((a <= 0) != (b <= 0)) next.push_back(p + a / (a - b) * (q - p));
    }
    left = std::move(next);
  }
  Projection projection;
  for (const Vec3& p : left) projection.emplace_back(e.dot(p), f.dot(p));
  return projection;
}

double distance_to(const Projection& outline, const Vec2& p) {
  double least = std::numeric_limits<double>::infinity();
  bool left = true, right = true;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 &a = outline[k], along = outline[(k + 1) % outline.size()] - a, to = p - a;
    const double t = along.squaredNorm() > 0 ? std::clamp(to.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
    least = std::min(least, (to - t * along).norm());
    const double turn = along.x() * to.y() - along.y() * to.x();
    left = left && turn > 0;
    right = right && turn < 0;
  }
  return left || right ? 0 : least;
}

/// The largest disc on a wall's middle plane.
InteriorDisc disc_on(const WallPlane& plane, const Solid& solid, double depth) {
  const double within = kWithin * plane.half;
  const Vec3 e = plane.normal.unitOrthogonal(), f = plane.normal.cross(e);
  std::vector<Projection> outlines;
  for (std::uint32_t t = 0; t < solid.mesh.triangles.size(); ++t)
    if (Projection near = near_plane(solid.bvh.corners(t), plane, within, e, f); !near.empty())
      outlines.push_back(std::move(near));
  // Distance from the outlines, or less than it where it is at most `enough`.
  const auto clearance = [&](const Vec2& p, double enough) {
    double least = std::numeric_limits<double>::infinity();
    for (const Projection& o : outlines) {
      least = std::min(least, distance_to(o, p));
      if (least <= enough) break;
    }
    return least;
  };
  Vec2 best = Vec2::Zero();
  double widest = 0;
  const auto improves = [&](const Vec2& p) {
    const double r = clearance(p, widest);
    if (!(r > widest) || !std::isfinite(r)) return false;
    widest = r;
    best = p;
    return true;
  };
  const std::size_t stride = 1 + plane.on.size() / 24;  // about 24 starts, spread over the wall
  for (std::size_t k = 0; k < plane.on.size(); k += stride) improves({e.dot(plane.on[k]), f.dot(plane.on[k])});
  // Steps shorter than the clearance do not lead out of the solid.
  for (double step = 0.5 * widest; step > 1e-3 * widest;) {
    bool moved = false;
    for (int k = 0; k < 8 && !moved; ++k)
      moved = improves(best + step * Vec2(std::cos(pi * k / 4), std::sin(pi * k / 4)));
    step = moved ? std::min(step, 0.5 * widest) : 0.5 * step;
  }
  InteriorDisc disc;
  disc.center = solid.frame * (plane.offset * plane.normal + best.x() * e + best.y() * f);
  disc.axis = solid.frame.q * plane.normal;
  disc.radius = widest - within;
  disc.half = within - depth;
  return disc;
}

}  // namespace

std::vector<InteriorDisc> discs_in(const Solid& solid, const std::vector<MedialBall>& balls, double depth,
                                   std::size_t most) {
  std::vector<InteriorDisc> discs;
  for (const WallPlane& plane : planes_of(solid, balls, depth)) {
    const InteriorDisc disc = disc_on(plane, solid, depth);
    if (disc.radius > 2 * disc.half) discs.push_back(disc);  // for a thicker part, enclosed_ball is more suitable
  }
  std::stable_sort(discs.begin(), discs.end(),
                   [](const InteriorDisc& a, const InteriorDisc& b) { return a.radius > b.radius; });
  if (discs.size() > most) discs.resize(most);
  return discs;
}

}  // namespace dismantle::immobility
