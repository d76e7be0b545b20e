/// Is a point inside a solid, asked very often?
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

/// A grid whose cells remember, from when they are first asked for, that they are all inside or all outside, or the
/// triangles that come near them and where their centre is. Safe to use from several threads. Outlived by
/// the surface, which has no border.
class Occupancy {
 public:
  /// `box`: of the surface. `cell`: edge of the cells, > 0, or more where the box is large.
  Occupancy(const TriangleBvh& surface, const Aabb& box, double cell);
  ~Occupancy();
  Occupancy(Occupancy&&) = default;
  Occupancy& operator=(Occupancy&&) = delete;

  bool inside(const Eigen::Vector3d& local) const;

 private:
  /// What surface passes through a cell.
  struct Mixed {
    Eigen::Vector3d center;
    int winding = 0;  ///< number of the centre
    std::vector<std::uint32_t> triangles;
  };
  using State = const Mixed*;  // or one of kIn, kOut; nothing: unknown

  State look(const Eigen::Vector3d& center) const;
  std::optional<int> crossings(const Mixed& cell, const Eigen::Vector3d& to) const;

  static const Mixed kIn, kOut;
  const TriangleBvh* surface_;
  Aabb box_;
  double cell_;
  std::array<std::size_t, 3> count_;
  std::unique_ptr<std::atomic<State>[]> cells_;
};

}  // namespace dismantle::immobility
