/// How deep two surfaces that meet reach into each other. FCL's own depth for meshes is a guess from single pairs of
/// triangles; here it is a distance.
#pragma once

#include <span>
#include <vector>

#include "body.h"

namespace dismantle::mesh_collision {

/// Measures depth; keeps its buffers. One per thread.
class DepthGauge {
 public:
  /// What to do besides looking at the middles of what is inside.
  struct Effort {
    double resolution = 5e-4;  ///< exact to this much, from below; assembly units
    double enough = 1;         ///< ends early at this depth
    bool thorough = true;      ///< false: no more than a few points per edge, for a quick lower bound
  };

  /// Largest depth, in assembly units, that a point on an edge (or corner) of `a` has in `b`: the distance to the
  /// surface of the solid of b that it is inside of; 0 when none is inside. `a_to_b`: shape frame to shape frame.
  ///
  /// `pairs`: triangles that meet, `of_second`: a is the second of each pair. Where the edges of the first
  /// go through the second is computed from them; between two such places an edge is inside or outside as a whole. From
  /// corners that are inside the search goes on along all edges there. Along the part of an edge that is inside, the
  /// deepest point is found by bisection with bounds.
  double deepest(const Body& a, const Body& b, const Pose& a_to_b, std::span<const TrianglePair> pairs, bool of_second,
                 const Effort& effort);
  /// The same when no triangles meet, from the corners given: shells that may be inside as a whole.
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
