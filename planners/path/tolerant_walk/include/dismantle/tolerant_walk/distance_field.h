/// Signed distances to one part, computed on demand.
#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/mesh.h"
#include "dismantle/tolerant_walk/resolution.h"

namespace dismantle::tolerant_walk {

/// Two grids: a fine grid near the surface, and a coarse grid that tells how far away the surface is. Values are
/// interpolated; at edges their error is up to about a third of a cell. A value does not depend on earlier queries.
/// Memory grows with use. Thread-safe.
class DistanceField {
 public:
  DistanceField(std::shared_ptr<const Mesh> mesh, const Resolution& resolution);

  /// Assembled frame of the part, assembly units; negative inside.
  double at(const Eigen::Vector3d& p);
  const Resolution& resolution() const { return resolution_; }
  const TriangleBvh& bvh() const { return bvh_; }
  const Mesh& mesh() const { return *mesh_; }
  const Aabb& box() const { return box_; }  ///< of the part
  std::size_t bytes() const;                ///< approximate memory

 private:
  class Grid {
   public:
    Grid(const Aabb& box, double cell);
    ~Grid();
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;
    /// Computes missing values with `field`. If `field` is null, the result is NaN where values are missing.
    double at(const Eigen::Vector3d& p, const DistanceField* field);
    double cell() const { return cell_; }
    std::size_t bytes() const { return count_ * sizeof(known_[0]) + blocks_known_ * sizeof(Block); }

   private:
    static constexpr int kCells = 8;  // along the edge of a block; a power of two, so that divisions are fast
    static constexpr std::size_t kBlock = kCells + 1;  // grid points; neighbouring blocks share a face
    /// NaN: not computed yet. All threads compute the same value, so the order of writes does not matter.
    using Block = std::array<std::atomic<float>, kBlock * kBlock * kBlock>;
    struct Known {
      int sign = 0;  ///< 0: unknown
      double bound;  ///< upper bound of the distance from the surface
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
  /// `sign`: 0 if unknown. `bound`: expected upper bound of the distance; the query is faster if it holds.
  double measured(const Eigen::Vector3d& p, int sign, double bound) const;

  Resolution resolution_;
  std::shared_ptr<const Mesh> mesh_;
  TriangleBvh bvh_;
  Aabb box_, around_;
  bool closed_;
  Grid coarse_, fine_;
  double surely_fine_;  ///< below this distance the coarse grid never reports a distant surface
};

}  // namespace dismantle::tolerant_walk
