/// Moving towards a target in a simulator: what is in the way turns the motion along itself.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "dismantle/path/path_thinning.h"
#include "dismantle/path_planner.h"
#include "parameters.h"

namespace dismantle::tunnel_forest {

/// Pushes the bodies towards given poses, aiming anew after each push. Contact does the retraction: where a straight
/// motion would penetrate, the simulator lets the bodies slide.
class Guide {
 public:
  Guide(World& world, const Parameters& parameters);

  struct Trip {
    State end;
    Path way;           ///< begin excluded, end included
    double length = 0;  ///< of the way, assembly units, by the point that moves most (bound)
    bool arrived = false;
    bool blocked = false;  ///< something is in the way
  };
  /// Ends on arrival, after `range` (assembly units), when nothing comes nearer to the target any more, or when `stop`
  /// says so (asked before each push).
  Trip go(const State& from, const std::vector<Pose>& target, double range, const std::function<bool()>& stop);

  /// Way of the body that has furthest to go: centre plus radius times angle. Bounds that of each of its points.
  double distance(const std::vector<Pose>& from, const std::vector<Pose>& to) const;
  std::uint64_t steps() const { return steps_; }  ///< simulated so far
  const std::vector<path::Ball>& bodies() const { return bodies_; }

 private:
  World& world_;
  double force_, push_time_;
  double reach_ = 0;  ///< longest way that a full push went with nothing in its way; 0: none has yet
  std::vector<path::Ball> bodies_;
  std::uint64_t steps_ = 0;
};

}  // namespace dismantle::tunnel_forest
