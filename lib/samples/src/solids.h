/// Building blocks of the samples: rectilinear solids, lofts (and so surfaces of revolution), threads.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "dismantle/mesh.h"

namespace dismantle::samples {

using Point = Eigen::Vector3d;
using Loop = std::vector<Point>;  ///< closed polygon, counter-clockwise about the direction of travel

/// Boxes added and cut in the order of the calls. The mesh consists of boundary faces of the grid that all box
/// coordinates span, so that neighbouring faces share whole edges.
class Cells {
 public:
  Cells& add(const Point& lo, const Point& hi);
  Cells& cut(const Point& lo, const Point& hi);
  Mesh mesh() const;

 private:
  struct Op {
    Point lo, hi;
    bool solid;
  };
  std::vector<Op> ops_;
};

/// Triangles between consecutive loops. Seen as a profile in the (radius, z) half plane, the loops run
/// counter-clockwise around the material: out along the bottom, up the outside, back in along the top.
class Loft {
 public:
  /// Adds a loop and joins it to the one before: by index when both have equally many points, otherwise
  /// by angle about the z axis (both loops must then be star-shaped about it).
  Loft& to(const Loop& loop);
  /// Adds an already triangulated strip from loop `first` to loop `last`.
  Loft& strip(const Mesh& mesh, const std::vector<std::uint32_t>& first, const std::vector<std::uint32_t>& last);
  Mesh capped();  ///< closes the first and the last loop by fans about their centroids
  Mesh ring();    ///< joins the last loop to the first

 private:
  using Ids = std::vector<std::uint32_t>;
  void join(const Ids& a, const Ids& b);
  void join_by_angle(const Ids& a, const Ids& b);
  void fan(const Ids& loop, bool start);
  Mesh mesh_;
  Ids first_, last_;
};

/// `segments` points on the circle of radius r about the z axis, at height z.
Loop circle(double r, double z, int segments);
/// The rectangle [-half_x, half_x] x [-half_y, half_y] at height z, starting in the first quadrant.
Loop rectangle(double half_x, double half_y, double z);
/// Regular hexagon with the given distance between opposite sides.
Loop hexagon(double across_flats, double z);
/// Circle of radius r, centred at `angle` (rad) on a circle of radius `bend_radius` around the z axis and perpendicular
/// to that circle; counter-clockwise about the direction of increasing angles.
Loop tube_section(double bend_radius, double r, double angle, int segments);
/// Circumradius of the regular polygon with `segments` corners that contains the circle of radius r.
double around(double r, int segments);

/// Axial section of a thread, period `pitch`: radius at the crest, root and on the straight flanks between.
struct ThreadProfile {
  double pitch = 1;
  double crest_radius = 1, root_radius = 0.5;
  double crest_flat = 0.125;  ///< axial length of the part at crest_radius, centred on phase 0
  double root_flat = 0.25;    ///< axial length at root_radius, centred on half a pitch
  double radius(double phase) const;
};

/// Right-handed helical surface z = pitch * angle / 2 pi + phase between the planes z0 < z1, facing away from the axis.
struct ThreadWall {
  Mesh mesh;
  std::vector<std::uint32_t> bottom, top;  ///< boundary loops, counter-clockwise from above
  double half_gap = 0;                     ///< half of the largest angle between neighbouring points, rad
};
ThreadWall thread_wall(const ThreadProfile& profile, double z0, double z1, int segments);
/// The same surface facing the axis.
Mesh reversed(Mesh mesh);

double volume(const Mesh& mesh);
/// @throws std::logic_error naming `name` unless the mesh is closed, oriented, free of degenerate triangles
/// and of positive volume.
void require_solid(const Mesh& mesh, const std::string& name);

}  // namespace dismantle::samples
