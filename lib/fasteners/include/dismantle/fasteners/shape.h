/// Recognises what a part is by its shape alone.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "dismantle/export.h"
#include "dismantle/fasteners/kinds.h"
#include "dismantle/mesh.h"

namespace dismantle::fasteners {

/// What the shape of a part says. Positions are in the frame and unit of the mesh, sizes in millimetres.
struct Shape {
  Kind kind = Kind::other;
  double confidence = 0;  ///< in [0, 1]
  std::string reason;     ///< for people
  std::string size{};     ///< thread ("M3", "1/4-20") or dimensions ("8x5x1"); empty: no table fits
  double length = 0;      ///< of a screw below its head, else along the axis; 0: not known
  Drive drive = Drive::none;
  double drive_size = 0;                            ///< across flats, or the number of a Torx
  bool threaded = false;                            ///< the thread is modelled
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit; of a screw from its tip to its head
  Eigen::Vector3d top = Eigen::Vector3d::Zero();    ///< on the axis, at the end that the axis points to
  double height = 0;                                ///< along the axis, unit of the mesh
  double radius = 0;                                ///< largest distance from the axis, unit of the mesh
  double shank_radius = 0;                          ///< of a screw or pin, or of a hole; unit of the mesh
  double head_height = 0;                           ///< of a screw, unit of the mesh
  double recess_depth = 0;                          ///< of the drive below the top, unit of the mesh
  /// Of a shape that is not known: roundness(); 1 where it was not looked at.
  double roundness = 1;
};

/// `mm`: millimetres in a unit of the mesh, > 0. The mesh must be closed; open ones are `other`. The pose, the scale
/// (with `mm`) and the triangulation change only rounding.
DISMANTLE_API Shape recognise_shape(const Mesh& mesh, double mm);

/// A part that is known to be a screw or a nut, whatever its sizes: the axis, the head and the shank of a screw with a
/// head, or the axis and the hole of a nut that is not round. None: it has no such form.
DISMANTLE_API std::optional<Shape> shape_as(Kind kind, const Mesh& mesh, double mm);

}  // namespace dismantle::fasteners
