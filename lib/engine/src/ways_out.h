/// Who is in whose way along a direction, for groups of many parts.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/simulator.h"

namespace dismantle {

/// Equal for unit vectors that are the same but for rounding.
std::array<int, 3> rounded_direction(const Eigen::Vector3d& direction);

/// Could a box that moves along `along`, as far as it takes, ever meet another?
bool may_meet(const Aabb& moving, const Aabb& fixed, const Eigen::Vector3d& along);

/// Remembers, for each part and direction, the few parts that are in its way. Parts that leave a group leave the lists of
/// the others as they are; so choosing the next of n parts costs n, once all have been looked at. Parts that have moved
/// are looked at again.
class WaysOut {
 public:
  using Placed = std::vector<PlacedPart>;
  /// Of a direction: how far the hull of a part reaches along it.
  using Reach = std::function<double(const PlacedPart& part, const Eigen::Vector3d& along)>;
  /// How much of `fixed` is in the way of `moving`, >= 0. Asked of pairs whose boxes may meet.
  using Thickness =
      std::function<double(const PlacedPart& moving, const PlacedPart& fixed, const Eigen::Vector3d& along)>;

  /// `boxes`: of all parts of the assembly, in their own frames.
  WaysOut(std::vector<Aabb> boxes, Reach reach, Thickness thickness);

  /// The parts that are asked about next.
  void look_at(const Placed& group);

  /// Ways of the group along one direction.
  class Along {
   public:
    /// How much the rest of the group is in the way of the unit, summed over pairs of parts.
    double thickness(const Placed& unit) const;
    /// How far it goes until a plane across the direction is between the two.
    double length(const Placed& unit) const;

   private:
    friend class WaysOut;
    Along(WaysOut& ways, const Eigen::Vector3d& direction);
    WaysOut& ways_;
    std::size_t row_;
    double furthest_ = 0, second_ = 0;  // reach of the group, and without the part that reaches furthest
    PartId front_ = 0;
  };
  Along along(const Eigen::Vector3d& direction) { return {*this, direction}; }

 private:
  struct InTheWay {
    PartId part;
    double thickness;
  };
  struct Entry {
    bool measured = false, listed = false;
    double ahead = 0, behind = 0;
    std::vector<InTheWay> blockers;  // ascending
  };
  struct Row {
    Eigen::Vector3d direction;
    std::vector<Entry> of;  // by part
  };
  Entry& measured(Row& row, const PlacedPart& part);
  const std::vector<InTheWay>& blockers(Row& row, const PlacedPart& part);

  std::vector<Aabb> boxes_;
  Reach reach_;
  Thickness thickness_;
  std::vector<Row> rows_;
  const Placed* group_ = nullptr;
  std::vector<std::size_t> family_;  // by part: of those that were in one group when its lists were made; 0: none
  std::vector<Pose> pose_;           // by part, when its lists were made
  std::vector<Aabb> placed_box_;     // by part
  std::vector<bool> present_;        // by part
  std::size_t families_ = 0;
};

}  // namespace dismantle
