/// Moves bodies towards a target in a simulator; they slide along obstacles in between.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "dismantle/path/path_thinning.h"
#include "dismantle/path_planner.h"
#include "parameters.h"

namespace dismantle::tunnel_forest {

/// Pushes the bodies towards given poses and aims again after each push. Contact retracts the bodies: where a straight
/// motion would penetrate, they slide in the simulator.
class LocalPlanner {
 public:
  /// `arrival`: a target counts as reached at this distance (assembly units). A direct motion over that distance
  /// penetrates by at most half of it.
  LocalPlanner(World& world, const Parameters& parameters, double arrival);

  struct Trajectory {
    State end;
    Path path;          ///< begin excluded, end included
    double length = 0;  ///< assembly units; no point moves further
    bool arrived = false;
    bool blocked = false;  ///< by an obstacle
  };
  /// Ends on arrival, after `range` (assembly units), when the bodies come no nearer to the target, or when `stop`,
  /// which is called before each push, returns true.
  Trajectory steer(const State& from, const std::vector<Pose>& target, double range, const std::function<bool()>& stop);

  /// Largest displacement of a body: that of its centre plus radius times angle, a bound for all its points.
  double distance(const std::vector<Pose>& from, const std::vector<Pose>& to) const;
  std::uint64_t steps() const { return steps_; }  ///< simulated so far
  const std::vector<path::Ball>& bodies() const { return bodies_; }

 private:
  World& world_;
  double force_, push_time_, stall_, arrival_;
  std::int64_t idle_pushes_;
  double free_push_ = 0;  ///< longest travel of a full push without obstacles so far; 0: none yet
  std::vector<path::Ball> bodies_;
  std::uint64_t steps_ = 0;
};

}  // namespace dismantle::tunnel_forest
