/// Signed distances to one part, computed where first asked for.
#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/mesh.h"

namespace dismantle::tolerant_walk {

/// Two grids, one for near the surface and a coarse one that says where that is. Interpolated, so not exact: within
/// about a third of a cell at edges. What it says does not depend on what was asked before. Memory follows use. Safe
/// to use from several threads.
class SolidField {
 public:
  SolidField(std::shared_ptr<const Mesh> mesh, double cell);

  /// Assembled frame of the part, assembly units; negative inside.
  double at(const Eigen::Vector3d& p);
  /// Measured, not interpolated.
  double exactly(const Eigen::Vector3d& p) const;
  double error() const { return kError * fine_.cell(); }  ///< of at() near the surface, at most about
  const TriangleBvh& bvh() const { return bvh_; }
  const Mesh& mesh() const { return *mesh_; }
  const Aabb& box() const { return box_; }  ///< of the part
  std::size_t bytes() const;                ///< about so much memory

 private:
  class Grid {
   public:
    Grid(const Aabb& box, double cell);
    ~Grid();
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;
    /// Without a field only what is known already; else not a number.
    double at(const Eigen::Vector3d& p, const SolidField* field);
    double cell() const { return cell_; }
    std::size_t bytes() const { return count_ * sizeof(known_[0]) + blocks_known_ * sizeof(Block); }

   private:
    static constexpr std::size_t kBlock = 9;  // places along the edge of a block, its last ones those of the next, too
    /// Not a number: not known. Whoever finds a value finds the same, so it does not matter who writes it.
    using Block = std::array<std::atomic<float>, kBlock * kBlock * kBlock>;
    struct Known {
      int sign = 0;  ///< 0: not known
      double most;   ///< distance from the surface
    };
    Known from_neighbours(const Block& block, std::ptrdiff_t place) const;
    Block& make(std::atomic<Block*>& place);

    Aabb box_;
    double cell_, inverse_cell_ = 0;
    std::array<std::int64_t, 3> blocks_{};
    std::size_t count_ = 1;
    std::unique_ptr<std::atomic<Block*>[]> known_;
    std::atomic<std::size_t> blocks_known_{0};
  };
  static constexpr double kError = 0.35;  // of a cell
  /// `sign`: 0 if not known. `most`: the distance is less, mostly.
  double exact(const Eigen::Vector3d& p, int sign, double most) const;

  std::shared_ptr<const Mesh> mesh_;
  TriangleBvh bvh_;
  Aabb box_, around_;
  bool closed_;
  Grid coarse_, fine_;
  double surely_near_;  ///< less than that in the fine grid: the coarse one cannot say that it is far
};

}  // namespace dismantle::tolerant_walk
