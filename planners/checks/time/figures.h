/// Estimated times of manual assembly: Boothroyd, Dewhurst and Knight, Product Design for Manufacture and Assembly,
/// second edition, 2002, chapter 3, tables of manual handling and of manual insertion. Seconds.
#pragma once

#include <string>

namespace dismantle::checks {

/// A part in the hand. Lengths in mm, angles in degrees.
struct Handled {
  double size = 0;       ///< largest edge of its smallest box
  double thickness = 0;  ///< smallest edge
  double alpha = 360;    ///< turn about an axis across the direction of insertion after which it is the same again
  double beta = 360;     ///< the same about the direction of insertion; 0: any turn
  bool tangles = false;  ///< with others of its kind: springs, circlips
  bool heavy = false;    ///< more than 10 pounds
};

/// How a part gets to its place.
struct Inserted {
  enum class Secured { no, at_once, screwed } secured = Secured::no;  ///< at once: a press fit, a snap
  bool hard_to_align = false;
  bool resisting = false;   ///< it has to be pressed
  bool obstructed = false;  ///< access or view
  bool held = false;        ///< by hand until a later step secures it
};

/// A figure and the two digits under which it stands in the tables.
struct Figure {
  double seconds = 0;
  std::string code{};
};

/// Time to grasp, orient and move a part.
Figure handling(const Handled& part);
/// Time to put it in.
Figure insertion(const Inserted& how);
inline constexpr double kTurningOver = 9;  ///< the whole: code 98

}  // namespace dismantle::checks
