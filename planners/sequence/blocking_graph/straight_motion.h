/// Which subassemblies can leave their group in a straight line, and along which direction.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "blocking_graph/directions.h"
#include "blocking_graph/relations.h"
#include "blocking_graph/state.h"

namespace dismantle::blocking {

/// A blocked direction remembers one subassembly that is in the way, and is not examined again while that one is there.
/// `next` in the functions below: subassemblies that will probably be asked about afterwards; idle threads answer the
/// questions about them in advance.
class StraightMotion final : public GroupListener {
 public:
  /// Along `directions`. All references must outlive this.
  StraightMotion(DisassemblyState& state, PathOracle& oracle, const PairSweep& sweep, Directions directions);

  /// Of the shortest path among the first few directions of which one is free.
  std::optional<std::size_t> free_direction(const GroupState& group, SubassemblyId id,
                                            std::span<const SubassemblyId> next = {});
  /// Everything that `id` would run into.
  Subassemblies blockers(const GroupState& group, SubassemblyId id, std::size_t direction);
  /// By member, in the group's order: indices of the members that it would run into. Empty when the run is to stop.
  std::vector<std::vector<std::size_t>> blocking_graph(const GroupState& group, std::size_t direction);
  /// Of the directions common to all, the blockers along the one that has fewest.
  Subassemblies fewest_blockers(const GroupState& group, SubassemblyId id, std::span<const std::size_t> directions);
  /// Proposes to the oracle that `ids` leave along the direction, as far as the test of hulls asks for, and commits the
  /// answer if the path is accepted. A refusal is remembered until a group changes.
  bool leave(GroupState& group, const Subassemblies& ids, std::size_t direction);
  bool was_refused(const Subassemblies& ids, std::size_t direction) const;
  /// How far `ids`, translated by `shift` at first, have to go along the direction until the hulls are apart.
  double length_out(const GroupState& group, const Subassemblies& ids, std::size_t direction,
                    const Eigen::Vector3d& shift = Eigen::Vector3d::Zero()) const;

  /// Directions of `id`, the one with the shortest path out of the group first.
  std::vector<std::size_t> directions_of(const GroupState& group, SubassemblyId id) const;
  const Directions& directions() const { return directions_; }
  /// Does `a` pass `b` along any direction of either?
  bool passes_any(PartId a, PartId b);
  /// The same as far as it is known: `blocks_all_known`: every direction was examined, and is blocked;
  /// `passes_any_known`: one was examined, and is free.
  bool blocks_all_known(PartId a, PartId b) const;
  bool passes_any_known(PartId a, PartId b) const;

  // For RotationInPlace, which asks with one part rotated.
  /// Is `blocker` the one that is remembered to be in the way? Then it is forgotten.
  bool forget_blocker(SubassemblyId id, std::size_t direction, SubassemblyId blocker);
  bool is_blocked(SubassemblyId id, std::size_t direction) const { return blocker_[id].contains(direction); }
  /// Pairs that have to be known to decide whether `id` is free along the direction, the likeliest blocker first.
  /// Empty: decided, and is_blocked() says how.
  std::vector<Pair> open_pairs(const GroupState& group, SubassemblyId id, std::size_t direction);
  bool blocks(const Pair& pair) { return relations_.blocks(pair); }
  /// `moving`, translated by `shift`, past `fixed`.
  Pair pair_of(PartId moving, PartId fixed, std::size_t direction,
               const Eigen::Vector3d& shift = Eigen::Vector3d::Zero()) const;
  /// Way along the direction after which the moving part is past the other one.
  double distance_past(const Pair& pair) const { return relations_.distance_past(pair); }

  std::uint64_t computed() const { return relations_.computed(); }
  void on_group_changed(GroupState& group, const GroupChange& change) override;

 private:
  std::vector<Pair> pairs_of(SubassemblyId moving, SubassemblyId fixed, std::size_t direction) const;
  double path_length(const GroupState& group, const Subassemblies& ids, std::size_t direction,
                     const Eigen::Vector3d& shift = Eigen::Vector3d::Zero()) const;
  std::vector<std::size_t> own_directions(SubassemblyId id) const;
  std::pair<std::optional<SubassemblyId>, std::vector<Pair>> examine(const GroupState& group, SubassemblyId id,
                                                                     std::size_t direction) const;
  void resolve(const GroupState& group, SubassemblyId id, std::span<const SubassemblyId> next);
  void hint(const GroupState& group, std::span<const std::size_t> directions, SubassemblyId id,
            std::span<const SubassemblyId> next);
  void hint_after_removal(const GroupState& group, const Subassemblies& ids);

  DisassemblyState& state_;
  PathOracle& oracle_;
  const PairSweep& sweep_;
  Directions directions_;
  Relations relations_;
  std::vector<std::map<std::size_t, SubassemblyId>> blocker_;      // by subassembly, by direction: one in the way
  std::set<std::pair<std::vector<PartId>, std::size_t>> refused_;  // since the last change
};

}  // namespace dismantle::blocking
