/// How deep two surfaces that meet reach into each other. FCL's own depth for meshes is a guess from single pairs of
/// triangles; here it is a distance.
#pragma once

#include <vector>

#include "body.h"

namespace dismantle::mesh_collision {

/// Measures depth; keeps its buffers. One per thread.
class DepthGauge {
 public:
  /// Largest depth, in assembly units, that a point on a bent edge (or corner) of `a` has in `b`: distance to the
  /// surface of the solid of b that it is inside of; 0 when none is inside. `a_to_b`: shape frame to shape frame.
  ///
  /// Starts at the edges of `triangles` (indices into a; those that meet b), and follows the surface of a from
  /// corner to corner as long as it is inside. Along an edge the deepest point is found by bisection with bounds, so it
  /// is exact to `resolution` (from below), however long the edge. Ends early at a depth of `enough` or more.
  double deepest(const Body& a, const Body& b, const Pose& a_to_b, const std::vector<std::uint32_t>& triangles,
                 double resolution, double enough);

  /// The same for all of a: when a is wholly inside b.
  double deepest(const Body& a, const Body& b, const Pose& a_to_b, double resolution, double enough);

 private:
  void open(std::uint32_t edge);
  double follow(const Body& a, const Body& b, const Pose& a_to_b, double resolution, double enough);

  std::vector<std::uint32_t> stamp_;  ///< by edge of a: the last measurement that saw it
  std::uint32_t now_ = 0;
  std::vector<std::uint32_t> open_;
};

/// Deepest point in `solid` on the line from p to q, searched only as far as it beats `best` by `resolution`;
/// returns the better of both. `inside_p`, `inside_q`: whether the ends are inside.
double deepest_on_line(const SolidPart& solid, const Eigen::Vector3d& p, const Eigen::Vector3d& q, double best,
                       double resolution, double enough, bool* inside_p, bool* inside_q);

}  // namespace dismantle::mesh_collision
