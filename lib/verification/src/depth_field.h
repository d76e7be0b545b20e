/// Bounds of the depth of all points of a solid.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/geometry/solid.h"

namespace dismantle {

/// The depth of the points in a closed solid, bounded in cells that are divided where it is asked for. It is the same
/// for all that cuts in, and for all motions: where a part passes the middle of another one, thousands of its triangles
/// sweep the same points. Not safe to share between threads.
class DepthField {
 public:
  /// The solid must outlive it.
  explicit DepthField(const geometry::Solid& solid);

  /// Allows more divisions of cells: what is bounded here has to take less time than it saves.
  void allow(double divisions) { allowed_ += divisions; }
  /// True if no point of the box (frame of the solid) is deeper than `level`. False: one is, or that would take cells
  /// smaller than `least`, or more divisions than are allowed.
  bool at_most(double level, const Aabb& box, double least);

 private:
  struct Cell {
    Eigen::Vector3d center;
    double half = 0;             // of an edge
    double depth = 0;            // at the centre
    double bound = 0;            // of the depth in the cell
    std::uint32_t children = 0;  // the first of eight; 0: none yet
  };
  void add(const Eigen::Vector3d& center, double half, double bound);
  bool at_most(std::uint32_t cell, double level, const Aabb& box, double least);

  const geometry::Solid& solid_;
  std::vector<Cell> cells_;
  double allowed_ = 0;
};

}  // namespace dismantle
