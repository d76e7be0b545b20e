/// The states that a part reaches by translations. They are kept for the whole run, and extended when parts that
/// blocked them have left.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "blocking_graph/straight_motion.h"

namespace dismantle::state_based {

using blocking::GroupState;
using blocking::Subassemblies;
using blocking::SubassemblyId;

struct MotionStateParameters {
  std::size_t states = 24;  ///< most states of one part
  unsigned stops = 1;       ///< states per translation: at contact, and evenly spaced before it
  unsigned halvings = 12;
  double retreat = 1;        ///< distance kept from contact; tolerances of the verifier
  double least_step = 0.05;  ///< shortest translation that is kept; share of the part's diagonal
};

/// The blocking graph of each part, enriched with its motion states: the blockers from every state along every
/// direction.
class MotionStates {
 public:
  /// `tolerance`: of the verifier, assembly units. All references must outlive this.
  MotionStates(blocking::DisassemblyState& state, blocking::StraightMotion& straight, const blocking::PairSweep& sweep,
               double tolerance, const MotionStateParameters& params);

  /// Waypoints of a path that removes a single part: translations from its pose in the group, the first zero. Extends
  /// the known states, breadth first. Nothing: no path through up to params.states of them. Paths that were refused
  /// since the group changed are not returned again.
  std::optional<std::vector<Eigen::Vector3d>> path_out(const GroupState& group, SubassemblyId id);
  /// Records that the verifier refused the last path of this part.
  void refuse(SubassemblyId id);
  void on_group_changed() { refused_.clear(); }

  /// The smallest set of blockers over all states of the part and all directions, among the sets without `stays` (which
  /// will not be removed). Nothing: all sets contain it.
  std::optional<Subassemblies> fewest_blockers(const GroupState& group, SubassemblyId id, SubassemblyId stays) const;
  std::size_t size(SubassemblyId id) const;
  std::uint64_t states() const;  ///< of all parts
  /// Examinations that were saved because the states are kept.
  std::uint64_t kept() const { return kept_; }

 private:
  struct Translation {
    bool examined = false;
    Subassemblies in_way;     ///< all blockers up to infinity, when it was examined
    SubassemblyId first = 0;  ///< the one that is met first; while it is in the group, the result stays valid
  };
  struct State {
    Eigen::Vector3d at;  ///< translation since the pose in the group
    std::size_t parent = 0;
    std::map<std::size_t, Translation> translations{};  ///< by direction
  };
  struct Edge {
    std::size_t state = 0, direction = 0;
    bool operator<(const Edge& o) const { return std::tie(state, direction) < std::tie(o.state, o.direction); }
  };
  Subassemblies in_way(const GroupState& group, SubassemblyId id, const State& state, std::size_t direction);
  double free_distance(SubassemblyId id, const State& state, std::size_t direction, Translation& translation) const;
  void add_stops(std::vector<State>& states, std::size_t from, std::size_t direction, double distance,
                 double least) const;
  double least_step(PartId part) const;

  blocking::DisassemblyState& state_;
  blocking::StraightMotion& straight_;
  const blocking::PairSweep& sweep_;
  double tolerance_;
  MotionStateParameters params_;
  std::map<SubassemblyId, std::vector<State>> states_;
  std::map<SubassemblyId, Edge> last_;
  std::map<SubassemblyId, std::set<Edge>> refused_;
  std::uint64_t kept_ = 0;
};

}  // namespace dismantle::state_based
