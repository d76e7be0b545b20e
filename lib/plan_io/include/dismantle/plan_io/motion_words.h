/// The motion of a part in numbers and in words.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/pose.h"

namespace dismantle {

/// A motion as a reader sees it: straight stretches and turns.
struct MotionSummary {
  /// Displacements of the point along the straight stretches of its path, input units. Empty when it stays where it is.
  std::vector<Eigen::Vector3d> stretches;
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< from begin to end, input units
  double length = 0;                                       ///< of the path of the point, input units
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();         ///< unit; of the turn, by the right-hand rule
  double turn = 0;                                         ///< rad, >= 0, full turns counted
};

/// The path of `point` (assembled frame), simplified by the rule of Douglas and Peucker (Cartographica 10(2), 1973): no
/// pose's point is further than `tolerance` (input units, > 0) from the stretches.
DISMANTLE_API MotionSummary summarize_motion(const std::vector<Pose>& poses, const Eigen::Vector3d& point,
                                             double tolerance);

/// The point (assembled frame) on the axis of the largest turn in the motion that is nearest to `near`; `near` for a
/// motion without turns. A screw moves it straight along its axis, wherever the part is.
DISMANTLE_API Eigen::Vector3d point_on_axis(const std::vector<Pose>& poses, const Eigen::Vector3d& near);

/// The motion with lengths in a unit of which one input unit is `factor`.
DISMANTLE_API MotionSummary in_unit(MotionSummary motion, double factor);

/// The tolerance of summarize_motion() for text about an assembly whose largest edge is `size`: readers do not notice a
/// hundredth.
inline double stretch_tolerance(double size) { return 0.01 * size; }

/// Three significant digits, without an exponent for what people measure: "1270", "18.3", "0.05".
DISMANTLE_API std::string figure_text(double x);

/// "+Z", "(-0.71, 0, -0.71)".
DISMANTLE_API std::string axis_text(const Eigen::Vector3d& direction);

/// "up (+Z)", "left and down (-0.71, 0, -0.71)": the axes of the assembly seen by someone who stands before it.
/// `drawn_up` (unit) points up in drawings: with Z up it is seen from -Y, with Y up from +Z, see upright(). `direction`
/// need not be a unit vector. `lies`: how the assembly is turned, from how it is drawn; the words are for the person,
/// the axis that of the assembly.
/// @throws Error for a direction without length.
DISMANTLE_API std::string direction_words(const Eigen::Vector3d& direction, const Eigen::Vector3d& drawn_up,
                                          const Eigen::Quaterniond& lies = Eigen::Quaterniond::Identity());

/// "upside down", "on its left side (+X up)": how an assembly lies whose direction `up` (unit) points upwards.
DISMANTLE_API std::string lie_words(const Eigen::Vector3d& up, const Eigen::Vector3d& drawn_up);

/// "40 mm down (-Z), then 3 mm left (-X)", "15 mm down (-Z), turning clockwise by 5 turns": one phrase. All slides
/// along three orthogonal axes are told, of other motions up to four stretches. Clockwise is seen along the motion, or
/// along the axis that is named. `unit` may be empty.
DISMANTLE_API std::string motion_words(const MotionSummary& motion, const std::string& unit,
                                       const Eigen::Vector3d& drawn_up,
                                       const Eigen::Quaterniond& lies = Eigen::Quaterniond::Identity());

}  // namespace dismantle
