/// A grid that answers quickly whether a point is inside a solid.
#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle::immobility {

/// A cell is classified when it is first needed: inside, outside, or mixed, with the triangles near it and the winding
/// number of its centre. Safe to use from several threads. The surface is closed and must outlive the grid.
class Occupancy {
 public:
  /// `box`: of the surface. `cell`: edge of the cells, > 0; enlarged if the grid would have too many cells.
  Occupancy(const TriangleBvh& surface, const Aabb& box, double cell);
  ~Occupancy();
  Occupancy(Occupancy&&) = default;
  Occupancy& operator=(Occupancy&&) = delete;

  bool inside(const Eigen::Vector3d& local) const;

 private:
  /// A cell that the surface passes through, or nearly.
  struct Mixed {
    Eigen::Vector3d center;
    int winding = 0;  ///< winding number of the centre
    std::vector<std::uint32_t> triangles;
  };
  using State = const Mixed*;  ///< of the cell, or &in_, or &out_; nullptr: not classified yet

  State classify(const Eigen::Vector3d& center) const;
  std::optional<int> crossings(const Mixed& cell, const Eigen::Vector3d& to) const;

  static const Mixed in_, out_;
  const TriangleBvh* surface_;
  Aabb box_;
  double cell_, rounding_;
  std::array<std::size_t, 3> count_;
  std::unique_ptr<std::atomic<State>[]> cells_;
};

}  // namespace dismantle::immobility
