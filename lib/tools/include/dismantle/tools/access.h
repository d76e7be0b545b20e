/// Does a tool reach a fastener past the parts that are there?
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/fasteners/kinds.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/pose.h"
#include "dismantle/tools/catalogue.h"

namespace dismantle::tools {

/// A fastener in place. Positions in assembly units, sizes in millimetres.
struct Fastener {
  Eigen::Vector3d top = Eigen::Vector3d::Zero();    ///< on the axis, at the end that the tool comes to
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit; points to the tool
  double mm = 1;                                    ///< millimetres in an assembly unit, > 0
  fasteners::Kind kind = fasteners::Kind::screw;
  fasteners::Drive drive = fasteners::Drive::none;
  double size = 0;    ///< of the drive, or the outer diameter of a part without one; a Torx: its number
  double grip = 0;    ///< height of the head or nut
  double radius = 0;  ///< of the head, nut or ring
  double travel = 0;  ///< along the axis, from where it is put on to its seat
};

/// A part that is there.
struct Obstacle {
  const TriangleBvh* surface = nullptr;
  bool closed = true;  ///< it has an inside
  Pose pose{};         ///< of the part; identity: as assembled
};

/// Angles of a tool about the axis, in [0, 2 pi]: ascending ranges, without overlap.
using Arcs = std::vector<std::pair<double, double>>;

/// True if the tool is made for the drive, or the kind of part, and its size.
DISMANTLE_API bool fits(const Tool& tool, const Fastener& fastener);

/// The origin of the volumes of a tool that is on its fastener, in assembly units.
DISMANTLE_API Eigen::Vector3d seat_of(const Use& use, const Fastener& fastener);
/// The volumes as they are on this fastener: what stands beside it is moved out to its circumference.
DISMANTLE_API std::vector<Volume> volumes_on(std::vector<Volume> volumes, const Use& use, const Fastener& fastener);

/// The angles at which the tool, anywhere on its travel along the axis, meets the part. Everything else is proved to be
/// clear on the part's triangles; what could not be decided within 1e-4 rad counts as blocked. The result does not
/// depend on the other parts that are there.
DISMANTLE_API Arcs blocked_angles(const Use& use, const Fastener& fastener, const Obstacle& obstacle, bool hand);

/// Where a tool has room to turn, or what is in the way.
struct Access {
  const Use* use = nullptr;                          ///< of the tool; null: the tool has none
  double start = 0;                                  ///< rad: the tool turns from here by the swing
  Eigen::Vector3d handle = Eigen::Vector3d::Zero();  ///< unit, in the middle of the swing; zero: it reaches nothing
  std::vector<std::size_t> obstacles;                ///< the fewest obstacles without which it had room, ascending
  bool reaches() const { return !handle.isZero(); }
};

/// Of one way to use a tool, with the blocked angles of each obstacle. A tool that reaches is in the middle of the
/// largest room.
DISMANTLE_API Access room_for(const Use& use, const Fastener& fastener, std::span<const Arcs* const> blocked);

/// Of the first way to use the tool that has room; else of the one with the fewest parts in the way.
DISMANTLE_API Access find_access(const Tool& tool, const Fastener& fastener, std::span<const Obstacle> present,
                                 bool hand = true);

}  // namespace dismantle::tools
