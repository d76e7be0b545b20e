/// Closest point of a triangle to a query point, and the feature that contains it.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace dismantle::sdf {

enum class Feature : std::uint8_t { face, edge0, edge1, edge2, corner0, corner1, corner2 };

struct Closest {
  Eigen::Vector3d offset;  ///< p minus the closest point
  double squared;
  Feature feature;
};

/// Closest point of triangle a, a + ab, a + ac to p (Ericson, Real-Time Collision Detection, 5.1.5).
inline Closest closest(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& ab,
                       const Eigen::Vector3d& ac) {
  const Eigen::Vector3d ap = p - a;
  const auto done = [](const Eigen::Vector3d& offset, Feature f) { return Closest{offset, offset.squaredNorm(), f}; };
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return done(ap, Feature::corner0);
  const Eigen::Vector3d bp = ap - ab;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return done(bp, Feature::corner1);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return done(ap - d1 / (d1 - d3) * ab, Feature::edge0);
  const Eigen::Vector3d cp = ap - ac;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return done(cp, Feature::corner2);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return done(ap - d2 / (d2 - d6) * ac, Feature::edge2);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return done(bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (ac - ab), Feature::edge1);
  const double inv = 1.0 / (va + vb + vc);
  return done(ap - (vb * inv) * ab - (vc * inv) * ac, Feature::face);
}

}  // namespace dismantle::sdf
