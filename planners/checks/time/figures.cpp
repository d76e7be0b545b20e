#include "figures.h"

#include <array>
#include <cstddef>

namespace dismantle::checks {

namespace {

// Rows: alpha + beta below 360, 540, 720, and 720. Columns: 0 to 4 easy to grasp, 5 to 9 difficult.
constexpr std::array<std::array<double, 10>, 4> kOneHand{{{1.13, 1.43, 1.88, 1.69, 2.18, 1.84, 2.17, 2.65, 2.45, 2.98},
                                                          {1.5, 1.8, 2.25, 2.06, 2.55, 2.25, 2.57, 3.06, 3.0, 3.38},
                                                          {1.8, 2.1, 2.55, 2.36, 2.85, 2.57, 2.9, 3.38, 3.18, 3.7},
                                                          {1.95, 2.25, 2.7, 2.51, 3.0, 2.73, 3.06, 3.55, 3.34, 4.0}}};
constexpr double kLargeSize = 381;  // mm, 15 inches: two hands
constexpr double kEqual = 1e-3;     // relative: a sheet of 2 mm is not thicker than 2 mm

bool above(double length, double limit) { return length > (1 + kEqual) * limit; }

Figure figure(double seconds, std::size_t row, std::size_t column) {
  return {seconds, std::to_string(row) + std::to_string(column)};
}

}  // namespace

Figure handling(const Handled& part) {
  if (part.heavy) return part.alpha < 360 ? figure(3, 9, 4) : figure(4, 9, 5);
  if (above(part.size, kLargeSize)) return part.alpha < 360 ? figure(2, 9, 0) : figure(3, 9, 1);
  const double turn = part.alpha + part.beta;
  const std::size_t row = turn < 360 ? 0 : turn < 540 ? 1 : turn < 720 ? 2 : 3;
  const std::size_t thick = above(part.size, 15) ? 0 : part.size >= (1 - kEqual) * 6 ? 1 : 2;
  const std::size_t thin = above(part.size, 6) ? 3 : 4;
  const std::size_t column = (above(part.thickness, 2) ? thick : thin) + (part.tangles ? 5 : 0);
  return figure(kOneHand[row][column], row, column);
}

Figure insertion(const Inserted& how) {
  const std::size_t obstructed = how.obstructed ? 1 : 0;
  switch (how.secured) {
    case Inserted::Secured::screwed: {
      constexpr double kScrewed[2][2] = {{6, 8}, {8.5, 10.5}};
      return figure(kScrewed[obstructed][how.resisting ? 1 : 0], 3 + obstructed, how.resisting ? 9 : 8);
    }
    case Inserted::Secured::at_once: {
      constexpr double kPressed[2][2] = {{2, 5}, {4.5, 7.5}};
      const std::size_t hard = how.resisting || how.hard_to_align ? 1 : 0;
      return figure(kPressed[obstructed][hard], 3 + obstructed, hard);
    }
    case Inserted::Secured::no:
      break;
  }
  constexpr double kPlaced[2][8] = {{1.5, 2.5, 2.5, 3.5, 5.5, 6.5, 6.5, 7.5}, {4, 5, 5, 6, 8, 9, 9, 10}};
  const std::size_t column = (how.hard_to_align ? 2 : 0) + (how.resisting ? 1 : 0) + (how.held ? 4 : 0);
  return figure(kPlaced[obstructed][column], obstructed, column + (how.held ? 2 : 0));  // digits 4 and 5 are not used
}

}  // namespace dismantle::checks
