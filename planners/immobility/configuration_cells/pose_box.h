/// The box of poses that a flood divides: which of its sides ways lead to, and how far out they have to be.
#pragma once

#include <array>
#include <cstddef>

#include "configuration_cells/pin_walk.h"
#include "configuration_cells/pose_cell.h"

namespace dismantle::immobility {

class PoseBox {
 public:
  /// Twelve sides: of each coordinate, the lower and the upper one.
  using Sides = std::array<bool, 12>;
  static std::size_t side(int coordinate, bool upper) { return 2 * static_cast<std::size_t>(coordinate) + upper; }

  /// Holds what the walk has reached, and more. `scale`: assembly units for one of each coordinate.
  PoseBox(const PinWalk& walk, const Vector6& scale);

  const Vector6& lo() const { return lo_; }
  const Vector6& hi() const { return hi_; }
  double extent() const { return (hi_ - lo_).cwiseProduct(scale_).maxCoeff(); }
  /// Sides that the cell is on.
  Sides touched(const PoseCell& cell) const;
  /// As a share of the box; 0 = on the border.
  double from_border(const PoseCell& cell) const;

  /// A pose further out than a cell on the border.
  Vector6 beyond(const PoseCell& cell) const;

  /// A way led to that cell on the border. `tells`: not a large one, which may be on many sides.
  void led_to(const PoseCell& cell, bool tells, std::size_t round);
  /// Sides that all ways have led to for long, if there are any: most likely the parts get there.
  Sides insisted_on(std::size_t round) const;
  /// Sides that the walk has got beyond.
  Sides passed_by(const PinWalk& walk) const;
  /// Moves a side out, further than the walk got and further each time. Returns what is new of the box.
  PoseCell grow(int coordinate, bool upper, const PinWalk& walk);
  /// From now on all ways have to insist anew.
  void begin_again(std::size_t round) { began_ = round; }

 private:
  Vector6 margin(const PinWalk& walk) const;

  Vector6 scale_, lo_, hi_;
  std::array<std::size_t, 12> led_at_{};  ///< by side: the round in which a way last led there
  std::size_t began_ = 0;
  std::array<double, 12> share_;  ///< by side: of the box, to grow the next time
};

}  // namespace dismantle::immobility
