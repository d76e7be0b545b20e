/// The states to which translations take a part, kept for the whole run: what is found while others are in the way is
/// gone on from when they have left.
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

struct MotionStateParams {
  std::size_t states = 24;  ///< of one part, at most
  unsigned stops = 1;       ///< of one translation: at contact, and evenly spaced before
  unsigned halvings = 12;
  double retreat = 1;      ///< from contact; tolerances of the verifier
  double least_step = 20;  ///< shortest translation that is kept; tolerances of the verifier
};

/// The blocking graph of each part, enriched with its motion states: from every state and along every direction, what
/// is in the way.
class MotionStates {
 public:
  /// `tolerance`: of the verifier, assembly units. All references must outlive this.
  MotionStates(blocking::DisassemblyState& state, blocking::StraightMotion& straight, const blocking::PairSweep& sweep,
               double tolerance, const MotionStateParams& params);

  /// Waypoints of a path that takes out a single part: translations since its pose in the group, the first zero. Goes
  /// on with the states that it has, breadth first; nothing: no path through at most params.states of them. Paths that
  /// were refused since the group changed are not found again.
  std::optional<std::vector<Eigen::Vector3d>> path_out(const GroupState& group, SubassemblyId id);
  /// The checker refused the last path of this part.
  void refuse(SubassemblyId id);
  void on_group_changed() { refused_.clear(); }

  /// Of all states of the part and all directions, the smallest set of others that is in the way, where `stays` (which
  /// will not be removed) is not among them. Nothing: it always is.
  std::optional<Subassemblies> fewest_blockers(const GroupState& group, SubassemblyId id, SubassemblyId stays) const;
  std::size_t size(SubassemblyId id) const;
  std::uint64_t states() const;  ///< of all parts
  /// Examinations that the states kept from before made needless: they would have been made anew from the assembly.
  std::uint64_t kept() const { return kept_; }

 private:
  struct Translation {
    bool examined = false;
    Subassemblies in_way;     ///< all that is in the way to infinity, when it was examined
    SubassemblyId first = 0;  ///< the one that is met first; as long as it is there, nothing changes
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
  void add_stops(std::vector<State>& states, std::size_t from, std::size_t direction, double distance) const;

  blocking::DisassemblyState& state_;
  blocking::StraightMotion& straight_;
  const blocking::PairSweep& sweep_;
  double tolerance_;
  MotionStateParams params_;
  std::map<SubassemblyId, std::vector<State>> states_;
  std::map<SubassemblyId, Edge> last_;
  std::map<SubassemblyId, std::set<Edge>> refused_;
  std::uint64_t kept_ = 0;
};

}  // namespace dismantle::state_based
