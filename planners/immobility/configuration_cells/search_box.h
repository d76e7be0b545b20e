/// The box of poses that is decomposed. Decides on which sides it should grow, and by how much.
#pragma once

#include <array>
#include <cstddef>

#include "configuration_cells/free_space_sampler.h"
#include "configuration_cells/pose_cell.h"

namespace dismantle::immobility {

class SearchBox {
 public:
  /// Twelve sides: of each coordinate, the lower and the upper one.
  using Sides = std::array<bool, 12>;
  static std::size_t side(int coordinate, bool upper) { return 2 * static_cast<std::size_t>(coordinate) + upper; }

  /// Contains all poses of the sampler, with a margin. `scale`: assembly units per unit of each coordinate. `patience`:
  /// rounds in which all paths must lead to a side before the side counts as persistent. `tolerance`: assembly units.
  SearchBox(const FreeSpaceSampler& sampler, const Vector6& scale, std::size_t patience, double tolerance);

  const Vector6& lo() const { return lo_; }
  const Vector6& hi() const { return hi_; }
  double extent() const { return (hi_ - lo_).cwiseProduct(scale_).maxCoeff(); }
  /// Sides that the cell touches.
  Sides sides_touched(const PoseCell& cell) const;
  /// Distance of the cell from the border, as a share of the box; 0 on the border.
  double border_distance(const PoseCell& cell) const;

  /// A pose beyond the border, further out than a cell that touches it.
  Vector6 pose_beyond(const PoseCell& cell) const;

  /// Records that a path led to that cell on the border. `small`: a large cell may touch many sides, so it resets the
  /// record.
  void record_exit(const PoseCell& cell, bool small, std::size_t round);
  /// Sides to which all recent paths have led, if any. Most likely the parts can move there.
  Sides persistent_sides(std::size_t round) const;
  /// Sides beyond which the sampler has a pose.
  Sides sides_exceeded(const FreeSpaceSampler& sampler) const;
  /// Moves a side out beyond the poses of the sampler, further each time. Returns the new part of the box.
  PoseCell grow(int coordinate, bool upper, const FreeSpaceSampler& sampler);
  /// Forgets the recorded exits.
  void restart(std::size_t round) { restarted_at_ = round; }

 private:
  Vector6 margin(const FreeSpaceSampler& sampler) const;

  Vector6 scale_;
  std::size_t patience_;
  double least_margin_;  ///< assembly units
  Vector6 lo_, hi_;
  std::array<std::size_t, 12> last_exit_{};  ///< by side: the last round in which a path led there
  std::size_t restarted_at_ = 0;
  std::array<double, 12> growth_;  ///< by side: share of the box by which it grows the next time
};

}  // namespace dismantle::immobility
