#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "disc/disc_cage.h"

namespace dismantle::immobility {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

constexpr double kWithin = 0.98;      // of the half thickness of a wall: free of its faces
constexpr double kOnePlane = 0.9999;  // cosine of the angle between directions of faces that are one plane
constexpr std::size_t kPlanes = 12;   // of a part's walls that are looked at
constexpr std::size_t kStarts = 24;   // centres of discs, to begin with
constexpr double kFlat = 2;           // a disc is flat if its radius is more times its half thickness

/// A wall's middle plane, and the balls on it.
struct WallPlane {
  Vec3 normal;
  double offset = 0, half = 0;
  std::vector<Vec3> on;
};

std::vector<WallPlane> planes_of(const Solid& solid, const std::vector<InnerBall>& middle, double depth) {
  std::vector<WallPlane> planes;
  for (const InnerBall& ball : middle) {
    if (!(kWithin * ball.radius > depth)) break;
    const Vec3 center = solid.frame.inverse() * ball.center;
    const Vec3 normal = solid.normals[solid.bvh.closest(center).triangle];
    const auto same = [&](const WallPlane& p) {
      return std::abs(p.normal.dot(normal)) > kOnePlane && std::abs(p.normal.dot(center) - p.offset) < 0.02 * p.half &&
             ball.radius > 0.95 * p.half;
    };
    const auto known = std::find_if(planes.begin(), planes.end(), same);
    if (known == planes.end())
      planes.push_back({normal, normal.dot(center), ball.radius, {center}});
    else
      known->on.push_back(center);
  }
  std::stable_sort(planes.begin(), planes.end(),
                   [](const WallPlane& a, const WallPlane& b) { return a.on.size() > b.on.size(); });
  if (planes.size() > kPlanes) planes.resize(kPlanes);
  return planes;
}

using Seen = std::vector<Vec2>;  // convex, either way round

/// What of a triangle is within `most` of the plane, seen along its normal.
Seen near_plane(const std::array<Vec3, 3>& corners, const WallPlane& plane, double most, const Vec3& e, const Vec3& f) {
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
  Seen seen;
  for (const Vec3& p : left) seen.emplace_back(e.dot(p), f.dot(p));
  return seen;
}

double from_seen(const Seen& outline, const Vec2& p) {
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
InnerDisc disc_on(const WallPlane& plane, const Solid& solid, double depth) {
  const double within = kWithin * plane.half;
  const Vec3 e = plane.normal.unitOrthogonal(), f = plane.normal.cross(e);
  std::vector<Seen> outlines;
  for (std::uint32_t t = 0; t < solid.mesh.triangles.size(); ++t)
    if (Seen seen = near_plane(solid.bvh.corners(t), plane, within, e, f); !seen.empty())
      outlines.push_back(std::move(seen));
  const auto room = [&](const Vec2& p, double enough) {
    double least = std::numeric_limits<double>::infinity();
    for (const Seen& o : outlines) {
      least = std::min(least, from_seen(o, p));
      if (least <= enough) break;
    }
    return least;
  };
  Vec2 best = Vec2::Zero();
  double widest = 0;
  const auto look = [&](const Vec2& p) {
    const double r = room(p, widest);
    if (!(r > widest) || !std::isfinite(r)) return false;
    widest = r;
    best = p;
    return true;
  };
  const std::size_t stride = 1 + plane.on.size() / kStarts;
  for (std::size_t k = 0; k < plane.on.size(); k += stride) look({e.dot(plane.on[k]), f.dot(plane.on[k])});
  // Steps shorter than the room there is do not lead out of the solid.
  for (double step = 0.5 * widest; step > 1e-3 * widest;) {
    bool moved = false;
    for (int k = 0; k < 8 && !moved; ++k) moved = look(best + step * Vec2(std::cos(pi * k / 4), std::sin(pi * k / 4)));
    step = moved ? std::min(step, 0.5 * widest) : 0.5 * step;
  }
  InnerDisc disc;
  disc.center = solid.frame * (plane.offset * plane.normal + best.x() * e + best.y() * f);
  disc.axis = solid.frame.q * plane.normal;
  disc.radius = widest - within;
  disc.half = within - depth;
  return disc;
}

}  // namespace

std::vector<InnerDisc> discs_in(const Solid& solid, const std::vector<InnerBall>& middle, double depth,
                                std::size_t most) {
  std::vector<InnerDisc> discs;
  for (const WallPlane& plane : planes_of(solid, middle, depth)) {
    const InnerDisc disc = disc_on(plane, solid, depth);
    if (disc.radius > kFlat * disc.half) discs.push_back(disc);
  }
  std::stable_sort(discs.begin(), discs.end(),
                   [](const InnerDisc& a, const InnerDisc& b) { return a.radius > b.radius; });
  if (discs.size() > most) discs.resize(most);
  return discs;
}

}  // namespace dismantle::immobility
