/// Path planners: how does this part (or group) leave?
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/outcome.h"
#include "dismantle/run_context.h"
#include "dismantle/simulator.h"

namespace dismantle {

/// Poses of the moving parts, instant by instant: path[k][i] is the pose of Cast::moving[i]. The first
/// entry is where they start. Between two instants each part moves by the joining screw motion.
using Path = Trace;

/// How hard to try. Counts come first: only they make results independent of the machine.
struct Effort {
  unsigned max_depth = 0;       ///< depth of the search tree, 0 = no limit (Algorithm 1: d_max)
  std::uint64_t max_steps = 0;  ///< simulated time steps or, without dynamics, state checks; 0 = no limit
  double timeout = 0;           ///< seconds, 0 = no limit beyond the context's deadline (t_max)
};

/// What the judge says of a path. A planner must not report `solved` with a path that was refused.
struct Verdict {
  bool accepted = false;
  // Filled when refused and the place is known:
  bool has_witness = false;
  PartId part = 0, other = 0;                       ///< `point` of `part` lies inside `other`
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< assembled frame of `part`
  std::size_t instant = 0;                          ///< path index at (or just after) which it happened
  std::string reason{};
  std::vector<Pose> poses{};  ///< of the moving parts when it happened; may be empty
};

/// What a search in vain has reached: states, and how they are reached. What is in it only planners of the kind that
/// made it know. Immutable; may be used by several searches at the same time, from any thread.
class DISMANTLE_API Reached {
 public:
  virtual ~Reached();
};

/// When a removal is complete.
struct Goal {
  /// Empty: the moving parts move as one group until its convex hull is apart from that of the fixed parts. Else the
  /// parts move independently and simultaneously until one of these (they are among the moving ones) is apart from all
  /// others, moving and fixed (World::leaves).
  std::vector<PartId> any_of{};
  /// Intermediate placement, of proposed paths only (no query has it): the parts are moved and stay in their group. The
  /// path has to be valid, and to separate nothing. Not together with any_of.
  bool placement = false;
  bool operator==(const Goal&) const = default;
};

struct PathQuery {
  const Assembly& assembly;
  const Simulator& simulator;
  const Prepared& prepared;
  Cast cast;
  Effort effort;
  /// Judges a finished path. Never empty. Planners call it with every path that they would return, from any thread.
  std::function<Verdict(const Path&)> judge;
  /// Empty: the moving parts are to come apart from the still ones, as one group. Else as Attempt::leaving: each moves
  /// in its own way, until one of these is apart from all other parts of the cast. World::separated does not tell that.
  std::vector<PartId> leaving{};
  /// Null, or what an earlier search in vain had reached: for the same moving parts from the same places and the same
  /// `leaving`, where the still parts were those of now and perhaps others, by a planner of the same kind with the same
  /// parameters. States that were reached then can be reached now: a planner may go on from there, or ignore it.
  const Reached* reached = nullptr;
};

struct PathResult {
  Outcome outcome = Outcome::crashed;
  Path path;                             ///< the accepted path iff is_success(outcome); front() = start
  unsigned depth = 0;                    ///< actions in the path
  std::map<std::string, double> counts;  ///< documented names, e.g. nodes, steps, refused
  std::vector<PartId> blocked_by;        ///< still parts that were touched, most often touched first
  std::vector<Pose> best_pose;           ///< failed: the state that came furthest, one pose per moving part
  std::string message;
  std::shared_ptr<const Reached> reached{};  ///< failed: where a later search can go on; null if it has to begin anew
};

/// Finds a removal motion. Stateless between calls: same parameters, query and seed give the same result.
/// Never prints; polls context.should_stop() at least every hundred simulated steps.
class DISMANTLE_API PathPlanner {
 public:
  virtual ~PathPlanner();
  /// Capabilities without which plan() returns `unsupported`.
  virtual Capabilities needs() const noexcept = 0;
  /// True: plan() answers queries with PathQuery::leaving. Others are never given one.
  virtual bool moves_each_its_way() const noexcept { return false; }
  /// True: plan() may be called from several threads at the same time. Then one object serves all threads of a run, and
  /// what it has computed for one search is there for all; else each thread has its own.
  virtual bool is_concurrent() const noexcept { return false; }
  virtual PathResult plan(const PathQuery& query, RunContext& context) = 0;
};

}  // namespace dismantle
