/// A grid that answers quickly whether a point is inside a solid.
#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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
  /// inside() of any of the points, several times faster than one by one: memory is fetched for many at a time.
  bool any_inside(std::span<const Eigen::Vector3d> local) const;

 private:
  struct Place {
    std::size_t index = 0;  ///< of the cell
    Eigen::Vector3d center;
  };
  /// A triangle near a cell, seen from its centre, with corners a, b and c. The products do not depend on the point
  /// that is asked about.
  struct Facet {
    Eigen::Vector3d normal;  ///< of length twice the area
    double height;           ///< of the centre above its plane, times the length of the normal
    double flat, reach;      ///< rounding of a height: `flat` times the sum of `reach` = |a| and the displacement
    double slack;            ///< rounding of the products below with a displacement, per length of it
    std::array<Eigen::Vector3d, 3> sides;  ///< a x b, b x c, c x a
  };
  /// A cell that the surface passes through, or nearly.
  struct Mixed {
    Eigen::Vector3d center;
    int winding = 0;        ///< winding number of the centre
    bool is_dense = false;  ///< too many facets: they are not listed
    std::vector<Facet> facets;
  };
  using State = const Mixed*;  ///< of the cell, or &in_, or &out_; nullptr: not classified yet

  Place place_of(const Eigen::Vector3d& local) const;
  State state_at(const Place& place) const;
  bool inside(const Eigen::Vector3d& local, State state) const;
  State classify(const Eigen::Vector3d& center) const;
  Facet facet_of(std::uint32_t triangle, const Eigen::Vector3d& center) const;
  static std::optional<int> crossings(const Mixed& cell, const Eigen::Vector3d& to);

  static const Mixed in_, out_;
  const TriangleBvh* surface_;
  Aabb box_;
  double cell_, rounding_;
  std::array<std::size_t, 3> count_;
  std::unique_ptr<std::atomic<State>[]> cells_;
};

}  // namespace dismantle::immobility
