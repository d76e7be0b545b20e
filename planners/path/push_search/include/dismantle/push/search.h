/// Push search in a simulator: Algorithm 1 and its extensions.
#pragma once

#include <compare>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "dismantle/geometry/twist.h"
#include "dismantle/path/state_set.h"
#include "dismantle/path_planner.h"
#include "dismantle/push/actions.h"
#include "dismantle/push/frame.h"
#include "dismantle/push/reached.h"
#include "dismantle/push/tactics.h"

namespace dismantle::push {

using geometry::Twist;

/// One search in one motion space. States form a tree; each has the instants of the motion from its parent.
///
/// A translating run ends where the part stops, because under a constant force it cannot move in circles. States in the
/// middle of such runs are expanded last. A run with rotation can move in circles, and often has to be stopped
/// half-way: the state after each planning time step is a node, and the run ends at known states.
///
/// Best first: the rank of a state grows with the number of similar states that were expanded and with the number of
/// stages of actions that it has had. States of equal rank are expanded in order of depth.
class Search {
 public:
  Search(const PathQuery& query, MotionSpace space, const Tactics& tactics, RunContext& context);

  /// Call it before the first run(). The search begins with `tree`, the result of tree() of an earlier search with the
  /// same moving parts, the same poses, and these fixed parts and perhaps others. States where runs ended at those
  /// other parts are expanded again; other runs are not repeated.
  void resume(const Tree& tree);
  /// The search tree so far.
  Tree tree() const;
  /// Simulated steps and state checks saved by resume().
  std::uint64_t spared() const { return spared_; }

  /// True if every motion that the contacts of the start allow is a rotation or screw, and one of these separates
  /// the part: then translations are useless. Cheap.
  bool screw_leads_out();

  /// What one call of run() may use.
  struct Limits {
    Deadline deadline;
    std::uint64_t* steps_left = nullptr;  ///< simulated steps and state checks, counted down;
                                          ///< nullptr = no limit
    /// States expanded in this call and in the paused calls before it; 0 = no limit. Expansions of the resumed search
    /// count, up to half of the limit.
    std::uint64_t expansions = 0;
    unsigned rank = ~0U;            ///< states of greater rank are not expanded
    std::uint64_t pause_after = 0;  ///< steps and state checks of this call, rounded up to whole states; 0 = no pause
    std::function<void()> between;  ///< called before each expansion, may block; may be empty
  };
  /// Continues where the last call stopped. `depth_limit`: states of greater depth or rank are left; `exhausted`: none.
  PathResult run(const Limits& limits);
  /// Simulated steps and state checks of all calls.
  std::uint64_t cost() const { return steps_ + state_checks_; }
  /// The last call ended because of `pause_after`.
  bool paused() const { return paused_; }

 private:
  enum class RunEnd { blocked, solved, refused_learned, refused, stop };
  /// A run along screws, so far.
  struct Run {
    State state;
    std::int32_t last = -1;  ///< node recorded last
    Path way;                ///< instants since then
    double length = 0;       ///< total length of the glides
  };

  void reset();
  void clear();
  std::vector<std::int32_t> out_by_now();
  bool out(const State& state);
  double way_from_start(const State& state) const;
  Path with_room(const Path& rubbing);
  unsigned rank(const Node& node) const;
  bool take_up_middles();
  RunEnd sweep(std::uint64_t expansions, PathResult& result);
  RunEnd expand(std::int32_t node, PathResult& result);
  std::vector<Action> actions_at(const Node& node, Stage stage);
  std::vector<Twist> twists_at(const Node& node);
  void add_contacts_of_pushes(const State& state, std::vector<Contact>& contacts);
  Action along(const Twist& twist, const State& state, const Eigen::Vector3d& lean = Eigen::Vector3d::Zero()) const;
  std::vector<Action> leaning_turns(const Node& node);
  double way_out(const State& from, const Twist& twist, const Eigen::Vector3d& center);
  RunEnd follow(std::int32_t from, const Action& action, Stage stage, unsigned depth, PathResult& result);
  RunEnd follow_screw(std::int32_t from, Twist twist, unsigned depth, PathResult& result);
  enum class GlideEnd { blocked, out, known, stop };
  struct Stretch {
    GlideEnd end;
    double way;
  };
  Stretch glide(const Twist& twist, const State& start, const State& origin, double clear, std::uint32_t first);
  void record(const Twist& twist, double way, unsigned depth, Run& run);
  RunEnd verify(std::int32_t last, const State& start, PathResult& result);
  std::vector<PartId> note_contacts(const State& state);
  void note_touched(std::int32_t node, const std::vector<PartId>& parts);
  Path path_to(std::int32_t node) const;
  std::int32_t add_node(std::int32_t parent, unsigned depth, const State& state, Path way, bool middle);
  void enqueue(std::int32_t node);
  void finish(PathResult& result) const;
  bool out_of_budget() const;
  double glide_step() const { return tactics_.glide_step * query_.tolerance; }
  double clearance() const { return tactics_.clearance * query_.tolerance; }
  double touch_distance() const { return tactics_.touch_distance * query_.tolerance; }
  bool turning() const { return world_->space() == MotionSpace::rigid; }

  const PathQuery& query_;
  const Tactics& tactics_;
  RunContext& context_;
  std::unique_ptr<World> world_;
  std::vector<path::Ball> bodies_;
  Eigen::Matrix3d axes_;  ///< columns: directions of the unit actions
  Extents extents_;       ///< at the start of the query
  const std::vector<Stage>& stages_;
  path::StateSet seen_,
      fine_;  ///< every recorded state, at the paper's and at a finer resolution
  std::vector<Node> nodes_;
  path::StateSet places_;  ///< expanded states, at a coarser resolution
  struct Waiting {
    unsigned rank, depth;
    std::int32_t node;
    auto operator<=>(const Waiting&) const = default;
  };
  std::set<Waiting> waiting_;
  std::size_t beyond_limit_ = 0;   ///< states too deep to be expanded
  std::vector<Middle> passed_;     ///< states in the middle of runs that are not nodes yet
  std::size_t passed_before_ = 0;  ///< number of those that became nodes or were dropped
  std::vector<Path> refusals_;
  Limits limits_;
  std::uint64_t pause_at_ = 0;  ///< total work at which this call pauses
  bool paused_ = false;
  bool sweep_paused_ = false;    ///< paused under a limit of expansions, which stays in force
  std::uint64_t sweep_end_ = 0;  ///< number of expansions at which the sweep ends
  bool may_relax_ = true;
  bool short_glides_ = false;  ///< the verifier has refused a glide
  std::vector<path::ContactSample> samples_;
  bool begun_ = false;                                 ///< run() has been called
  bool others_left_ = false;                           ///< fixed parts of the resumed search are absent now
  std::uint64_t spared_ = 0, kept_ = 0, resumed_ = 0;  ///< work, expansions and nodes of the resumed tree
  std::map<PartId, std::uint64_t> touched_;
  double farthest_ = -1;
  std::vector<Pose> best_;
  std::uint64_t steps_ = 0, state_checks_ = 0, refused_ = 0, expanded_ = 0, expanded_before_ = 0;
};

}  // namespace dismantle::push
