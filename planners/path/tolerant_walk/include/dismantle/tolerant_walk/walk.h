/// A random tree of poses that may penetrate as deep as the judge allows.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "dismantle/path/path_thinning.h"
#include "dismantle/path_planner.h"
#include "dismantle/tolerant_walk/parameters.h"
#include "dismantle/tolerant_walk/tolerance.h"

namespace dismantle::tolerant_walk {

/// What the simulator has to be capable of.
inline constexpr Capabilities kNeeds{};

class Walk {
 public:
  /// All three outlive this. Several moving parts move as one rigid body.
  Walk(const Parameters& parameters, const PathQuery& query, RunContext& context);

  /// Goes on until so many poses were looked at in all. `depth_limit`: that is the case; `exhausted`: the judge has
  /// refused too much.
  PathResult run(std::uint64_t most_looks);
  std::uint64_t looks() const { return looks_; }

 private:
  /// A displacement of all moving parts from where they start.
  struct Node {
    Pose pose;
    Eigen::Vector3d center;  ///< of the moving parts, there
    std::uint32_t parent = 0;
    bool cut = false;  ///< the judge has refused the way there
  };
  struct Step {
    Eigen::Vector3d way, turn;  ///< of the centre; rotation vector
  };

  bool halted() const;
  std::vector<Pose> poses(const Pose& displacement) const;
  State state(const Pose& displacement) const;
  bool allowed(const Pose& displacement);
  double distance(const Pose& a, const Pose& b) const;
  std::uint32_t add(const Pose& pose, std::uint32_t parent);
  std::uint32_t choose(Step& step);
  bool fly(PathResult& result);
  bool out(std::uint32_t node);
  std::vector<std::uint32_t> chain_to(std::uint32_t node) const;
  bool straight(const Pose& a, const Pose& b);
  std::vector<Pose> shortened(std::vector<Pose> way);
  Path path_of(const std::vector<Pose>& way) const;
  bool judged(std::uint32_t node, PathResult& result);
  void cut(const std::vector<std::uint32_t>& chain, const Pose& near);
  void finish(PathResult& result) const;

  const Parameters parameters_;
  const PathQuery& query_;
  RunContext& context_;
  Deadline deadline_;
  Rng rng_;
  std::unique_ptr<World> world_;
  Tolerance tolerance_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double radius_ = 0;
  std::vector<path::Ball> bodies_;
  std::vector<Node> nodes_;
  std::array<std::uint32_t, 26> furthest_{};  ///< nodes, by direction
  double looked_at_ = 0;                      ///< distance from the start at which it was last asked whether it is out
  std::uint64_t looks_ = 0, refused_ = 0;
  std::map<PartId, std::uint64_t> touched_;
};

}  // namespace dismantle::tolerant_walk
