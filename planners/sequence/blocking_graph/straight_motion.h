/// Which subassemblies can leave their group in a straight line, and along which direction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "blocking_graph/directions.h"
#include "blocking_graph/relations.h"
#include "blocking_graph/state.h"
#include "blocking_graph/unit_extents.h"

namespace dismantle::blocking {

/// Which directions a strategy tries.
enum class DirectionFilter {
  up,        ///< within 45 degrees of straight up (Objective::up): the reverse puts parts in from above
  not_down,  ///< all but those within 45 degrees of straight down
  any,
};

/// For each blocked direction one blocker is remembered, and the direction is not examined again while this blocker is
/// in the group. `next` in the functions below: subassemblies that will probably be asked about afterwards; idle
/// threads compute their relations speculatively.
class StraightMotion final : public GroupListener {
 public:
  /// Along `directions`. All references must outlive this.
  StraightMotion(DisassemblyState& state, PathOracle& oracle, const PairSweep& sweep, Directions directions);

  /// The free direction with the shortest path, among the first few directions that include a free one.
  std::optional<std::size_t> free_direction(const GroupState& group, SubassemblyId id,
                                            std::span<const SubassemblyId> next = {},
                                            DirectionFilter filter = DirectionFilter::any);
  /// All free directions that were not refused, in the order of their paths' lengths.
  std::vector<std::size_t> free_directions(const GroupState& group, SubassemblyId id);
  /// All subassemblies that block `id`.
  Subassemblies blockers(const GroupState& group, SubassemblyId id, std::size_t direction);
  /// A member of the group that is in the way when `ids` leave together; nullopt: none, or the run is to stop.
  std::optional<SubassemblyId> blocker_of(const GroupState& group, const Subassemblies& ids, std::size_t direction);
  /// The smallest groups that can move along the direction (see graph.h). Empty when the run is to stop.
  std::vector<Subassemblies> free_groups(const GroupState& group, std::size_t direction);
  /// The blockers along the direction of `directions` that has the fewest.
  Subassemblies fewest_blockers(const GroupState& group, SubassemblyId id, std::span<const std::size_t> directions);
  /// Proposes to the oracle that `ids` leave along the direction until the hulls are apart, and commits the answer if
  /// the path is accepted. A refusal is remembered until a group changes.
  bool leave(GroupState& group, const Subassemblies& ids, std::size_t direction);
  bool was_refused(const Subassemblies& ids, std::size_t direction) const;
  /// Length of the path along the direction, from the poses translated by `shift`, until the hulls are apart.
  double length_out(const GroupState& group, const Subassemblies& ids, std::size_t direction,
                    const Eigen::Vector3d& shift = Eigen::Vector3d::Zero()) const;

  /// The same by extents along the direction: no shorter.
  double path_length(const GroupState& group, const Subassemblies& ids, std::size_t direction,
                     const Eigen::Vector3d& shift = Eigen::Vector3d::Zero()) const;

  bool admits(DirectionFilter filter, std::size_t direction) const;
  /// Directions of `id`, the one with the shortest path out of the group first.
  std::vector<std::size_t> directions_of(const GroupState& group, SubassemblyId id) const;
  const Directions& directions() const { return directions_; }

  // For RotationInPlace, which examines pairs with one part rotated.
  /// Forgets the remembered blocker of the direction, if it is `blocker`. False: it is not.
  bool forget_blocker(SubassemblyId id, std::size_t direction, SubassemblyId blocker);
  bool is_blocked(SubassemblyId id, std::size_t direction) const { return blocker_[id].contains(direction); }
  /// Pairs whose relations are needed to decide whether `id` is free along the direction, the likeliest blocker first.
  /// Empty: decided, see is_blocked().
  std::vector<Pair> open_pairs(const GroupState& group, SubassemblyId id, std::size_t direction);
  bool blocks(const Pair& pair) { return relations_.blocks(pair); }
  /// The pair of `moving`, translated by `shift`, and `fixed`.
  Pair pair_of(PartId moving, PartId fixed, std::size_t direction,
               const Eigen::Vector3d& shift = Eigen::Vector3d::Zero()) const;
  /// Distance along the direction after which the moving part is past the other one.
  double distance_past(const Pair& pair) const { return relations_.distance_past(pair); }

  std::uint64_t computed() const { return relations_.computed(); }
  void on_group_changed(GroupState& group, const GroupChange& change) override;

 private:
  std::optional<std::size_t> blocker_outside(const GroupState& group, std::size_t member, std::size_t direction,
                                             const std::function<bool(std::size_t)>& inside);
  double gap_of(const Pair& pair) const;
  std::vector<Pair> pairs_of(SubassemblyId moving, SubassemblyId fixed, std::size_t direction) const;
  /// How far a group reaches along a direction, in the assembly's frame: farthest subassembly and second farthest.
  struct FarEnd {
    SubassemblyId farthest = 0, next = 0;
    double end = -std::numeric_limits<double>::infinity(), next_end = end;
  };
  void keep_far_ends(const GroupChange& change);
  const FarEnd& far_end(const GroupState& group, std::size_t direction) const;
  std::vector<std::size_t> own_directions(SubassemblyId id) const;
  std::pair<std::optional<SubassemblyId>, std::vector<Pair>> examine(const GroupState& group, SubassemblyId id,
                                                                     std::size_t direction) const;
  void resolve(const GroupState& group, SubassemblyId id, const std::vector<std::size_t>& directions,
               std::span<const SubassemblyId> next);
  void hint(const GroupState& group, std::span<const std::size_t> directions, SubassemblyId id,
            std::span<const SubassemblyId> next);
  void hint_after_removal(const GroupState& group, const Subassemblies& ids);
  double length_out(const GroupState& group, const Subassemblies& ids, std::size_t direction, const Attempt& attempt,
                    const Eigen::Vector3d& shift) const;

  DisassemblyState& state_;
  PathOracle& oracle_;
  const PairSweep& sweep_;
  Directions directions_;
  Relations relations_;
  mutable UnitExtents extents_;
  std::vector<std::map<std::size_t, SubassemblyId>> blocker_;      // by subassembly, by direction: one blocker
  std::set<std::pair<std::vector<PartId>, std::size_t>> refused_;  // since the last change
  struct {
    std::uint64_t arrangement = 0;
    std::optional<std::size_t> group;  // that has these members in this arrangement; none: not known
    Subassemblies members;
    std::map<std::size_t, FarEnd> by_direction;
  } mutable far_ends_;  // of the last group that was asked about, in the last arrangement
};

}  // namespace dismantle::blocking
