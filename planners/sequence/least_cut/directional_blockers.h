/// Which parts block which along a direction, for groups of many parts.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/simulator.h"

namespace dismantle::least_cut {

/// Equal for unit vectors that differ only by rounding.
std::array<int, 3> rounded_direction(const Eigen::Vector3d& direction);

/// Caches, for each part and direction, the few parts that block it (one direction of a directional blocking graph;
/// Wilson 1992), and how much of each is in the way. When a part leaves the group, the lists of the others stay valid,
/// so choosing the next of n parts costs O(n) once the lists are made. Lists of moved parts are made again.
class DirectionalBlockers {
 public:
  using Placed = std::vector<PlacedPart>;
  /// How far the hull of a part reaches along a direction.
  using Reach = std::function<double(const PlacedPart& part, const Eigen::Vector3d& along)>;
  /// How much of `fixed` is in the way of `moving`, >= 0. Asked of pairs whose boxes may meet.
  using Thickness =
      std::function<double(const PlacedPart& moving, const PlacedPart& fixed, const Eigen::Vector3d& along)>;

  /// `boxes`: of all parts of the assembly, in their own frames.
  DirectionalBlockers(std::vector<Aabb> boxes, Reach reach, Thickness thickness);

  /// Sets the group of the following queries; it must outlive them.
  void set_group(const Placed& group);

  /// Queries about the group along one direction.
  class Along {
   public:
    /// How much the rest of the group is in the way of the unit, summed over pairs of parts.
    double thickness(const Placed& unit) const;
    /// How far the unit must move until a plane perpendicular to the direction separates it from the rest.
    double length(const Placed& unit) const;

   private:
    friend class DirectionalBlockers;
    Along(DirectionalBlockers& all, const Eigen::Vector3d& direction);
    DirectionalBlockers& all_;
    std::size_t row_;
    double furthest_ = 0, second_ = 0;  // reach of the group, and without the part that reaches furthest
    PartId front_ = 0;
  };
  Along along(const Eigen::Vector3d& direction) { return {*this, direction}; }

 private:
  struct Blocker {
    PartId part;
    double thickness;
  };
  struct Entry {
    bool measured = false, listed = false;
    double ahead = 0, behind = 0;
    std::vector<Blocker> blockers;  // ascending
  };
  struct Row {
    Eigen::Vector3d direction;
    std::vector<Entry> of;  // by part
  };
  Entry& measured(Row& row, const PlacedPart& part);
  const std::vector<Blocker>& blockers(Row& row, const PlacedPart& part);

  std::vector<Aabb> boxes_;
  Reach reach_;
  Thickness thickness_;
  std::vector<Row> rows_;
  const Placed* group_ = nullptr;
  std::vector<std::size_t> list_id_;  // by part: equal for parts whose lists were made together; 0: no list
  std::vector<Pose> pose_;            // by part, when its lists were made
  std::vector<Aabb> placed_box_;      // by part
  std::vector<bool> present_;         // by part
  std::size_t last_list_id_ = 0;
};

}  // namespace dismantle::least_cut
