/// How far it is, through what is free, from anywhere between fixed parts to outside of them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/simulator.h"

namespace dismantle::free_space {

/// Cubic cells over the box of the fixed parts and a little more. A cell is free when no surface passes through it and
/// a small ball about its centre fits. Ways go from cell to neighbouring cell, keep away from walls where there is
/// room, and end at the rim, which is outside. World frame, assembly units.
class WaysOut {
 public:
  /// About `most_cells` cells. `ball`: radius of the ball that is to come out; it may be a cell wider than its way.
  WaysOut(const Assembly& assembly, const std::vector<PlacedPart>& fixed, double ball, std::size_t most_cells);

  double cell() const { return cell_; }  ///< edge of a cell
  /// Length of the way out; negative outside of all cells. Where nothing is free, or free but closed in, that of the
  /// nearest free cell and more.
  double length(const Eigen::Vector3d& p) const;
  /// How many cells it is from the one of `p` to one from which a way leads out; 0 is there.
  unsigned depth(const Eigen::Vector3d& p) const;
  /// The middles of the cells that the way out from the one of `p` leads through, that cell first. Empty: outside.
  std::vector<Eigen::Vector3d> way(const Eigen::Vector3d& p) const;
  /// A place on that way some cells ahead, or outside; never the same as `p`.
  Eigen::Vector3d ahead(const Eigen::Vector3d& p) const;
  /// The narrowest place on the first `reach` of the way out from `p` counts as closed from now on: what is not a ball
  /// has not got through. False when there is none.
  bool close_narrowest(const Eigen::Vector3d& p, double reach);

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  using Index = std::array<std::int32_t, 3>;

  void mark(const std::array<Eigen::Vector3d, 3>& corners);
  void measure_clearance();
  void find_ways();
  void reach_walls();
  std::uint32_t cell_of(const Eigen::Vector3d& p) const;  ///< kNone: outside
  std::uint32_t id(const Index& i) const;
  Eigen::Vector3d center(std::uint32_t cell) const;
  bool rim(std::uint32_t cell) const;
  template <typename Visit>
  void each_neighbour(std::uint32_t cell, const Visit& visit) const;
  std::uint32_t ahead_of(std::uint32_t cell) const;

  Aabb box_;
  double cell_ = 0;
  std::uint16_t least_ = 1;  // clearance of what is free, in thirds of a cell
  Index count_{};
  std::vector<std::uint16_t> clearance_;  // to the nearest cell with a surface, in thirds of a cell
  std::vector<std::uint32_t> cost_;       // of the way out, in kUnit-ths of a cell
  std::vector<float> length_;             // of that way, in cells
  std::vector<std::uint32_t> next_;       // on the way out; itself at the rim
  std::vector<std::uint8_t> depth_;
};

}  // namespace dismantle::free_space
