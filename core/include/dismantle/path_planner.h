/// Path planners: how is this part (or group) removed?
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/outcome.h"
#include "dismantle/run_context.h"
#include "dismantle/simulator.h"

namespace dismantle {

/// Poses of the moving parts, instant by instant: path[k][i] is the pose of Scene::moving[i]. The first
/// entry is where they start. Between two instants each part moves by the joining screw motion.
using Path = Trace;

/// How much a search may spend. Counts come first: only they make results independent of the machine.
struct Budget {
  unsigned max_depth = 0;       ///< depth of the search tree, 0 = no limit (Algorithm 1: d_max)
  std::uint64_t max_steps = 0;  ///< simulated time steps plus state checks; 0 = no limit
  double timeout = 0;           ///< seconds, 0 = no limit beyond the context's deadline (t_max)
};

class PathChecker;

/// A path that a PathChecker accepted. Only a checker creates one, so a search cannot report success with a refused
/// path.
class DISMANTLE_API VerifiedPath {
 public:
  /// The motion in the form that is written to the plan. It may have fewer or more instants than the checked path.
  const Path& poses() const { return poses_; }
  /// Certified upper bound over the whole path of the penetration above the initial overlap; assembly units.
  double max_penetration() const { return max_penetration_; }
  /// If the Goal names parts: the one that is separated from all others at the end.
  const std::optional<PartId>& released() const { return released_; }

 private:
  friend class PathChecker;
  VerifiedPath(Path poses, double max_penetration, std::optional<PartId> released, std::uint64_t checker);

  Path poses_;
  double max_penetration_ = 0;
  std::optional<PartId> released_;
  std::uint64_t checker_ = 0;
};

/// The verifier's answer about a path. When a path is refused and the place is known, `part` lies too deep in `other`.
struct PathCheck {
  std::optional<VerifiedPath> verified{};  ///< set: the path is accepted
  bool has_witness = false;                ///< refused, and the next five fields are filled
  PartId part = 0, other = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< of `part`, in its assembled frame
  std::size_t instant = 0;                          ///< index of the path at (or just before) the violation
  std::vector<Pose> poses{};                        ///< of the moving parts at the violation; may be empty
  std::string reason{};                             ///< refused: why
  bool accepted() const { return verified.has_value(); }
};

/// Decides whether a path is a valid removal or transfer. The engine implements it for each query.
class DISMANTLE_API PathChecker {
 public:
  PathChecker();
  virtual ~PathChecker();
  PathChecker(const PathChecker&) = delete;
  PathChecker& operator=(const PathChecker&) = delete;
  /// May be called from several threads at the same time.
  virtual PathCheck check(const Path& path) const = 0;
  /// True when this checker, and no other, accepted `path`.
  bool accepted(const VerifiedPath& path) const { return path.checker_ == id_; }

 protected:
  VerifiedPath accept(Path poses, double max_penetration, std::optional<PartId> released = {}) const;

 private:
  std::uint64_t id_;  ///< unique in the process
};

/// State that an unsuccessful search keeps, so that a later search can resume. Opaque except to the planner type that
/// made it, which recognises it with dynamic_cast. Immutable; may be used from several threads.
class DISMANTLE_API SearchState {
 public:
  virtual ~SearchState();
};

/// When a removal is complete.
struct Goal {
  /// Empty: the moving parts move as one group until its convex hull is apart from that of the fixed parts. Otherwise
  /// the parts move independently and simultaneously until one of these, which must be moving parts, is apart from all
  /// others, moving and fixed (World::body_separated).
  std::vector<PartId> any_of{};
  /// Intermediate placement, for proposed paths only (never in a query): the parts move and stay in their group. The
  /// path must be valid, but need not separate anything. Cannot be combined with any_of.
  bool placement = false;
  /// Directions (unit vectors, assembly frame) in which the parts must not leave: the mean displacement of the
  /// centres of the moving parts from the first to the last pose is at least `angle` away from each of them. The
  /// checker refuses other paths; planners may use it to leave out what would be refused. Not with `placement`.
  std::vector<Eigen::Vector3d> without{};
  double angle = 0.25;  ///< radians, 0 < angle < pi
  bool operator==(const Goal&) const = default;
};

/// One question to a path planner. All references outlive the search.
struct PathQuery {
  const Assembly& assembly;
  const Simulator& simulator;
  const PreparedAssembly& prepared;
  Scene scene;
  Budget budget;
  /// Penetration above the initial overlap that the verifier tolerates (`verify.max_penetration`); assembly units, >=
  /// 0. Planners keep a share of it in reserve, because simulators detect contact only at sample points.
  double tolerance;
  const PathChecker& checker;
  Goal goal{};
  /// Null, or the state of an earlier unsuccessful search by a planner of the same type and parameters, with the same
  /// moving parts at the same poses, the same goal, and at least the present fixed parts. States reachable then are
  /// reachable now. A planner may ignore it.
  const SearchState* resume_from = nullptr;
  /// For FunctionPathPlanner::plan(). True: `budget` may be that of a portion only; after `timeout`, plan() is called
  /// again, with a larger one. An anytime planner loses nothing if it says so, too, and ends with its best path
  /// (PathResult::may_improve): plan() is called again only if a better one is wanted.
  bool portion = false;
};

/// Effort and size of a search. The fixed fields mean the same for all planners.
struct DISMANTLE_API SearchStats {
  std::uint64_t steps = 0;          ///< simulated time steps
  std::uint64_t state_checks = 0;   ///< states that were tested without simulating
  std::uint64_t nodes = 0;          ///< states in search trees, including those taken over from an earlier search
  std::uint64_t refused = 0;        ///< paths that the checker refused
  std::uint64_t resumed_nodes = 0;  ///< nodes taken over from PathQuery::resume_from
  std::uint64_t spared = 0;         ///< steps and state checks saved by taking them over
  /// Machine-independent effort, for comparing searches: steps plus state checks, or a planner's own count if some of
  /// these cost far more than others.
  double cost = 0;
  std::map<std::string, double> extra{};  ///< counts of a certain planner, for reports; no code depends on the names

  SearchStats& operator+=(const SearchStats& other);  ///< adds up, extras by name
  bool operator==(const SearchStats&) const = default;
  /// The fields that are not zero, and all of `extra`, by name: for reports.
  std::map<std::string, double> by_name() const;
};

/// The answer of a path planner. Success cannot be claimed without a VerifiedPath, except for "nothing to do".
class DISMANTLE_API PathResult {
 public:
  /// No result yet: Outcome::crashed until an outcome is set.
  PathResult() = default;
  /// As fail().
  static PathResult failure(Outcome outcome, std::string message = {});

  Outcome outcome() const { return outcome_; }
  /// Set when solved. For start_is_goal the engine fills it.
  const std::optional<VerifiedPath>& path() const { return path_; }

  /// `depth`: number of actions in the path.
  void solve(VerifiedPath path, unsigned depth);
  /// There is nothing to do. `path` holds the start pose twice.
  void start_is_goal(std::optional<VerifiedPath> path = {});
  /// `outcome` must not be a success. An empty `message` keeps the present one.
  /// @throws std::invalid_argument for `solved` and `start_is_goal`.
  void fail(Outcome outcome, std::string message = {});

  unsigned depth = 0;  ///< actions in the path
  SearchStats stats{};
  std::vector<PartId> blocked_by{};               ///< fixed parts that were touched, most often touched first
  std::vector<Pose> best_pose{};                  ///< failed: the state that came furthest, one
                                                  ///< pose per moving part
  std::string message{};                          ///< failed: why, for the user
  std::shared_ptr<const SearchState> state = {};  ///< failed: where a later search can resume; may be null
  bool may_improve = false;                       ///< solved: another PathSearch::run() may find a better path

 private:
  Outcome outcome_ = Outcome::crashed;
  std::optional<VerifiedPath> path_{};
};

/// What a path planner type needs and can do; constant for an object.
struct PathPlannerTraits {
  Capabilities needs{};              ///< if the simulator lacks one of these, searches end as `unsupported`
  bool concurrent = false;           ///< start() may be called from several threads; one object serves them all
  bool simultaneous_motion = false;  ///< answers queries with Goal::any_of; other planners never get one
  bool resumable = false;            ///< uses PathQuery::resume_from and fills PathResult::state
};

/// Result of one portion of a search.
enum class SearchStatus {
  solved,     ///< a path was found, or there is nothing to do
  paused,     ///< the portion is used up; another run() continues
  exhausted,  ///< nothing is left to do within the query's budget; another run()
              ///< does nothing
  failed,     ///< cancelled, out of time, unsupported, or the start is not valid
};

/// The status that belongs to the end of a search.
DISMANTLE_API SearchStatus status_of(Outcome outcome);

/// A search that is run in portions. Used by one thread at a time.
class DISMANTLE_API PathSearch {
 public:
  virtual ~PathSearch();
  /// Continues where the last call stopped. `portion.max_steps` and `portion.timeout` limit this call; 0 = no limit
  /// beyond the query's budget, which covers all calls together. A step in progress at the end of the portion is
  /// completed. `portion.max_depth` is not used: the query limits the depth. After `solved` with
  /// PathResult::may_improve, the search goes on for a better path; it then keeps the best that it has.
  virtual SearchStatus run(const Budget& portion) = 0;
  /// Result of the search, or the result if it were abandoned now.
  virtual PathResult result() = 0;
};

/// Finds removal motions. Same parameters, query and seed give the same result. Never prints; polls
/// context.should_stop() at least every hundred simulated steps.
class DISMANTLE_API PathPlanner {
 public:
  virtual ~PathPlanner();
  virtual PathPlannerTraits traits() const noexcept = 0;
  /// `query`, `context` and this planner outlive the search. Time limits count
  /// from here.
  virtual std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) = 0;
};

/// Runs a search until it is over.
DISMANTLE_API PathResult run_to_end(PathSearch& search);
/// Starts a search and runs it until it is over.
DISMANTLE_API PathResult plan_path(PathPlanner& planner, const PathQuery& query, RunContext& context);

/// Base of planners that consist of one function. It keeps no state between portions: if plan() ends with `timeout`
/// only because of the portion, the next run() repeats it from the beginning, with its own, larger portion.
class DISMANTLE_API FunctionPathPlanner : public PathPlanner {
 public:
  std::unique_ptr<PathSearch> start(const PathQuery& query, RunContext& context) final;
  /// Must respect query.budget.
  virtual PathResult plan(const PathQuery& query, RunContext& context) = 0;
};

}  // namespace dismantle
