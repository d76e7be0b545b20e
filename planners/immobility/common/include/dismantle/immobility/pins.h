/// Points deep within one of two parts: while nothing cuts in too far, they stay out of the other.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/linear_bound.h"
#include "dismantle/immobility/occupancy.h"

namespace dismantle::immobility {

/// A point of one part that never enters a solid of the other: it is deeper below the surface of its own than the two
/// may cut in, and would have to pass through the solid's surface first.
struct Pin {
  bool of_a = true;
  std::uint32_t faced = 0;                       ///< the solid, as Pinned numbers them
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< assembled frame, from Pinned::center()
  double room = 0;                               ///< distance from the solid at first
};

/// Two parts and the pins of both. Where `a` is, seen from `b`, is told by six coordinates, all 0 when assembled: a
/// rotation vector, about the centre, and a shift of the centre.
class Pinned {
 public:
  /// The plane of a triangle, of length twice the area, and the lengths of two edges.
  struct Plane {
    Eigen::Vector3d normal;
    double length, edges;
  };
  struct Faced {
    const Solid* solid;
    Pose to_local;         ///< from the assembled frame
    Eigen::Matrix3d turn;  ///< of that
    Occupancy occupied;
    std::vector<Plane> planes;  ///< by triangle
  };

  /// Pins are `depth` (> 0) below the surface and more. Outlived by the solids.
  Pinned(const std::vector<Solid>& a, const std::vector<Solid>& b, double depth);

  const std::vector<Pin>& pins() const { return pins_; }
  const Faced& faced(const Pin& pin) const { return faced_[pin.faced]; }
  const Eigen::Vector3d& center() const { return center_; }
  double radius() const { return radius_; }  ///< of `a` about the centre
  /// About how far pins move, in assembly units, for one of each coordinate.
  const Vector6& scale() const { return scale_; }

 private:
  void add(const Solid& of, std::uint32_t faced, bool of_a, double depth, double spacing, double reach);

  std::vector<Faced> faced_;
  Eigen::Vector3d center_;
  double radius_ = 0;
  std::vector<Pin> pins_;
  Vector6 scale_;
};

/// Have the surfaces no border? Only then does whatever gets inside pass through them, as pins would have to.
bool borderless(const std::vector<Solid>& solids);

/// Where the two parts are, once.
class Stance {
 public:
  Stance(const Pinned& pinned, const Vector6& x);
  /// The pin, in the frame of the solid that it faces.
  Eigen::Vector3d seen(const Pin& pin) const;
  bool inside(const Pin& pin) const;
  /// The same, quicker where the pin cannot have come so far.
  bool barred_by(const Pin& pin) const { return pin.room <= moved_ && inside(pin); }
  /// No point of `a` has moved further.
  double moved() const { return moved_; }

 private:
  const Pinned* pinned_;
  Eigen::Matrix3d turn_;
  Eigen::Vector3d shift_;
  double moved_;
};

}  // namespace dismantle::immobility
