/// Who is in whose way: part j blocks part i along direction d if i, moved in a straight line along d until it is past
/// j, would cut into it. That depends on no other part, so it is computed once (Wilson and Latombe 1994: the
/// directional blocking graphs of an assembly).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "blocking_graph/directions.h"
#include "blocking_graph/orientations.h"
#include "blocking_graph/pair_sweep.h"
#include "dismantle/speculative_cache.h"

namespace dismantle::blocking {

/// Two parts as they stand, and where one of them is to go.
struct Pair {
  PartId moving = 0, fixed = 0;
  std::size_t direction = 0;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();           ///< translation of `moving` less that of `fixed`
  std::size_t orientation_moving = 0, orientation_fixed = 0;  ///< numbers of Orientations
};

/// A pair, how the two stand to each other, and a direction; see Relations.
using RelationKey = std::tuple<PartId, PartId, std::size_t, long, long, long, std::size_t, std::size_t>;

/// What is free here is a valid straight path past one part, up to the test of convex hulls at its end. Not safe to
/// call from several threads; idle threads of an executor, if given, help.
class Relations {
 public:
  /// All references must outlive this; `executor` may be null.
  Relations(const PairSweep& sweep, const Directions& directions, const Orientations& orientations,
            std::shared_ptr<Executor> executor);

  bool blocks(const Pair& pair);
  /// The same for many.
  void compute(std::span<const Pair> pairs);
  /// Asked for before, or far. What was found ahead does not count, so that threads do not show.
  bool known(const Pair& pair) const;
  /// Is it known, and does it block?
  bool known_to_block(const Pair& pair) const;
  /// Are there threads for what will probably be asked?
  bool works_ahead() const { return blocks_ahead_.computes_ahead(); }
  /// Is it worth telling them? They have little left.
  bool wants_hints() const { return works_ahead() && blocks_ahead_.waiting() < kEnoughHints; }
  /// Each list in the order in which it will be asked, until a pair is blocked. Replaces what was told before.
  void hint(const std::vector<std::vector<Pair>>& lists);
  /// Certainly apart all the way, by boxes alone.
  bool far(const Pair& pair) const;
  /// Way along d after which `moving` is past `fixed`.
  double distance_past(const Pair& pair) const;
  /// Extent of a part along a direction, turned but not translated.
  std::pair<double, double> extent(PartId part, std::size_t direction, std::size_t turn = 0) const;
  /// How many were asked for.
  std::uint64_t computed() const { return blocks_.size(); }

 private:
  struct Shadow {
    double lo[3], hi[3];  // along the direction and two across it
  };
  using Key = RelationKey;
  static constexpr std::size_t kEnoughHints = 8;
  static Pair canonical(Pair pair);
  static Key key_of(const Pair& pair);
  using Ahead = SpeculativeCache<RelationKey, bool>;
  Ahead::Request request(const Pair& pair) const;
  Shadow scene(PartId part, std::size_t direction, const Eigen::Matrix3d& turn) const;
  const Shadow& shadow(PartId part, std::size_t direction, std::size_t turn) const;

  const Directions& directions_;
  const PairSweep& sweep_;
  std::vector<Eigen::Matrix3d> frames_;               // by direction: rows are the direction and two across it
  mutable std::vector<std::vector<Shadow>> shadows_;  // by direction, by part; filled when first asked for
  const Orientations& orientations_;
  mutable std::map<std::tuple<std::size_t, std::size_t, PartId>, Shadow> rotated_shadows_;  // turn, direction, part
  std::map<Key, bool> blocks_;
  std::shared_ptr<Executor> executor_;
  Ahead blocks_ahead_;
};

}  // namespace dismantle::blocking
