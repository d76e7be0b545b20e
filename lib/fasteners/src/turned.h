// A mesh about an axis: sections across it, as radii by angle.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::fasteners {

/// Rays of a section; a multiple of 2, 3, 4, 5, 6.
inline constexpr std::size_t kRays = 360;
using Radii = std::array<double, kRays>;

/// The cut of a mesh by a plane across its axis, along rays from the axis.
struct Section {
  double z = 0;
  Radii outer;              ///< where each ray leaves the part at last; 0: it does not meet the part
  Radii inner;              ///< where it meets the part first; 0: it does not
  std::size_t crossed = 0;  ///< rays that meet the part
  bool filled = false;      ///< the axis is inside
  double area = 0;          ///< of the cut

  double outer_max() const;
  double inner_min() const;  ///< of the rays that meet the part
};

/// Symmetry of radii by angle.
struct Outline {
  double smallest = 0, largest = 0;
  int fold = 1;  ///< largest of 2, 3, 4, 6 whose turns map the radii to themselves; 0: they are equal (a circle)
  double ratio() const { return smallest > 0 ? largest / smallest : 0; }
};
Outline outline_of(const Radii& radii);

/// A closed outline of a section; coordinates across the axis.
struct Loop {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< of its area
  double smallest = 0, largest = 0;                  ///< distance of corners and edges from the centre
  double area = 0;                                   ///< enclosed, > 0
  bool hole = false;
};

/// Of the outline of a mesh seen along an axis: the smallest distance of 72 tangents of its convex hull from the axis,
/// over the largest one of a vertex. 1: a circle about the axis; a hexagon has about 0.87, a square 0.71; 0: the axis
/// passes outside.
double roundness(const Mesh& mesh, const Eigen::Vector3d& axis, const Eigen::Vector3d& point);

/// The shape of a mesh about one axis.
class Turned {
 public:
  Turned(const Mesh& mesh, const Eigen::Vector3d& axis, const Eigen::Vector3d& point);

  const Eigen::Vector3d& axis() const { return axis_; }
  double low() const { return low_; }
  double high() const { return high_; }
  double height() const { return high_ - low_; }
  Eigen::Vector3d at(double z) const { return point_ + z * axis_; }
  Section section(double z) const;
  /// The outlines of a section, outer ones and holes. The mesh must be closed and welded; others have none.
  std::vector<Loop> loops(double z) const;

 private:
  const Mesh* mesh_;
  Eigen::Vector3d axis_, point_, u_, v_;
  std::vector<Eigen::Vector3d> local_;  // x, y across, z along the axis
  double low_, high_;
};

/// The axis about which most of the surface is turned, with the share of the surface that is; none for a mesh without
/// area. Flat faces across the axis count as turned, flat faces along it half.
struct TurnedAxis {
  Eigen::Vector3d axis, point;
  double share = 0;
};
std::optional<TurnedAxis> turned_axis(const Mesh& mesh);

}  // namespace dismantle::fasteners
