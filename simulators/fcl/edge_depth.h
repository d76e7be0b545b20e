/// Penetration depth of two surfaces that meet, as a distance. FCL's own depth for meshes is an estimate from single
/// triangle pairs.
#pragma once

#include <span>
#include <vector>

#include "body.h"

namespace dismantle::mesh_collision {

/// Measures depth; keeps its buffers. One per thread.
class DepthGauge {
 public:
  /// Accuracy and stopping criteria of a measurement.
  struct Effort {
    double resolution = 5e-4;  ///< largest underestimate; assembly units
    double enough = 1;         ///< ends early at this depth
    bool thorough = true;      ///< false: only a few points per edge, for a quick lower bound
  };

  /// Largest depth, in assembly units, that a point on an edge (or corner) of `a` has in `b`: its distance to the
  /// surface of the solid of b that contains it; 0 if no point is inside. `a_to_b`: shape frame to shape frame.
  ///
  /// `pairs`: triangles that meet, `of_second`: a is the second of each pair. They give the crossings of the edges of a
  /// with the surface of b; between two crossings an edge is entirely inside or outside. From corners inside, the
  /// search continues along all their edges. On an inside piece of an edge, bisection with bounds finds the deepest
  /// point.
  double deepest(const Body& a, const Body& b, const Pose& a_to_b, std::span<const TrianglePair> pairs, bool of_second,
                 const Effort& effort);
  /// The same if no triangles meet, starting from `corners` of shells that may be entirely inside.
  double deepest(const Body& a, const Body& b, const Pose& a_to_b, std::span<const std::uint32_t> corners,
                 const Effort& effort);

 private:
  struct Crossing {
    std::uint32_t edge = 0;
    double place = 0;  ///< [0, 1] along the edge
    bool operator<(const Crossing& o) const { return edge != o.edge ? edge < o.edge : place < o.place; }
  };
  void begin(const Body& a);
  void open_corner(const Body& a, std::uint32_t vertex);
  void cross(const Body& a, const Body& b, const Pose& a_to_b, std::uint32_t of_a, std::uint32_t of_b);
  double follow(const Body& a, const Body& b, const Pose& a_to_b, const Effort& effort);

  std::vector<std::uint32_t> stamp_;  ///< by edge of a: the last measurement that saw it
  std::uint32_t now_ = 0;
  std::vector<std::uint32_t> open_;
  std::vector<Crossing> crossings_;
};

}  // namespace dismantle::mesh_collision
