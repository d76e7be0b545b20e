/// Moving towards a target in a simulator, along the obstacles in between.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "dismantle/path/path_thinning.h"
#include "dismantle/path_planner.h"
#include "parameters.h"

namespace dismantle::tunnel_forest {

/// Pushes the bodies towards given poses and aims again after each push. Contact does the retraction: where a straight
/// motion would penetrate, the simulator lets the bodies slide.
class LocalPlanner {
 public:
  /// `arrival`: distance (assembly units) at which a target is reached. A direct motion over it penetrates by half of
  /// it at most.
  LocalPlanner(World& world, const Parameters& parameters, double arrival);

  struct Trajectory {
    State end;
    Path path;          ///< begin excluded, end included
    double length = 0;  ///< assembly units; bound for the point that moves most
    bool arrived = false;
    bool blocked = false;  ///< by an obstacle
  };
  /// Ends on arrival, after `range` (assembly units), when the bodies come no nearer to the target, or when `stop`,
  /// which is called before each push, returns true.
  Trajectory steer(const State& from, const std::vector<Pose>& target, double range, const std::function<bool()>& stop);

  /// Largest displacement of a body: that of its centre plus radius times angle, which bounds that of its points.
  double distance(const std::vector<Pose>& from, const std::vector<Pose>& to) const;
  std::uint64_t steps() const { return steps_; }  ///< simulated so far
  const std::vector<path::Ball>& bodies() const { return bodies_; }

 private:
  World& world_;
  double force_, push_time_, stall_, arrival_;
  std::int64_t idle_pushes_;
  double free_push_ = 0;  ///< longest travel of a full push without obstacles; 0: there was none yet
  std::vector<path::Ball> bodies_;
  std::uint64_t steps_ = 0;
};

}  // namespace dismantle::tunnel_forest
