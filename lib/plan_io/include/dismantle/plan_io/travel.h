/// How far parts are led by others: until they are out of the hole, wherever their hulls separate.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"
#include "dismantle/plan_io/motion_words.h"

namespace dismantle {

/// A part, as an index into Assembly::parts, and its pose in input units.
using PosedParts = std::vector<std::pair<std::size_t, Pose>>;

/// The distance, in input units, that `moving` has to go along `direction` until nothing of `fixed` is beside it or
/// before it: the height of what is fixed within its silhouette along the direction, above its rear end. The silhouette
/// is widened by a twentieth of its size, more than the play of a fit. 0: it only rests on the others.
/// @throws std::out_of_range when the assembly has no such part.
DISMANTLE_API double guided_distance(const Assembly& assembly, const PosedParts& moving, const PosedParts& fixed,
                                     const Eigen::Vector3d& direction);

/// By step of Plan::disassembly: how far its parts are led, when it is one straight motion without a turn by which
/// parts leave the others (input units, not more than the length of the path). None: the whole path is what there is to
/// say. Empty: not measured.
using GuidedDistances = std::vector<std::optional<double>>;

/// @throws InputError when the plan has a part that the assembly lacks.
DISMANTLE_API GuidedDistances guided_distances(const Plan& plan, const Assembly& assembly);

/// True for one straight motion without a turn: only for these is a guided distance stated.
DISMANTLE_API bool is_straight(const MotionSummary& motion);

/// A distance of which people say "it only rests on the others", for an assembly whose largest edge is `size`.
inline double resting_distance(double size) { return 1e-3 * size; }

/// The guided distance if the motion has one (0 for a part that only rests), else the length of the path; input units.
DISMANTLE_API double stated_distance(const MotionSummary& motion, std::optional<double> guided, double size);

/// How a motion is told.
struct MotionPhrase {
  TextUnit unit;                                  ///< of lengths
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< as `drawn_up` of motion_words()
  double size = 1;                                ///< largest edge of the assembly, input units
  bool disassembly = false;                       ///< the part leaves
};
/// The words of motion_words() with the guided distance instead of the length of the path: "12 mm down (-Z)", or
/// "down (-Z), until it seats" (in the disassembly "up (+Z), free at once") for a part that only rests on the others.
/// `motion` and `guided` are in input units.
DISMANTLE_API std::string travel_words(const MotionSummary& motion, std::optional<double> guided,
                                       const MotionPhrase& phrase, const Eigen::Quaterniond& lies);

}  // namespace dismantle
