/// Which part blocks which: part j blocks part i along direction d if i, translated along d until it is past j,
/// penetrates it. That depends on no other part, so it is computed once (Wilson and Latombe 1994: the directional
/// blocking graphs of an assembly).
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blocking_graph/directions.h"
#include "blocking_graph/orientations.h"
#include "blocking_graph/pair_sweep.h"
#include "dismantle/speculative_cache.h"

namespace dismantle::blocking {

/// Two parts at their poses, and the direction along which one of them moves.
struct Pair {
  PartId moving = 0, fixed = 0;
  std::size_t direction = 0;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();           ///< translation of `moving` less that of `fixed`
  std::size_t orientation_moving = 0, orientation_fixed = 0;  ///< numbers of Orientations
};

/// A pair, its relative pose, and a direction; see Relations.
using RelationKey = std::tuple<PartId, PartId, std::size_t, long, long, long, std::size_t, std::size_t>;

/// Does one shape, translated along a direction, pass another? One question for all pairs of equal parts that lie
/// alike. The answer depends on these rounded numbers alone.
struct ShapeQuestion {
  PartId moving = 0, fixed = 0;                       ///< first parts of the two shapes
  std::array<std::int64_t, 3> offset{}, direction{};  ///< of `moving`, in the frame of `fixed`
  std::array<std::int64_t, 4> rotation{};             ///< of `moving`, in the frame of `fixed`: w, x, y, z
  std::int64_t length = 0;                            ///< of the translation
  double overlap = 0;                                 ///< when assembled; assembly units
  auto operator<=>(const ShapeQuestion&) const = default;
};

/// Answers that the planners of a run share: a question says all that its answer depends on. Safe to use from several
/// threads.
class SharedAnswers {
 public:
  /// Those of the oracle of `sweep`, if it shares its memo with other planners.
  static const SharedAnswers& of(const PairSweep& sweep);
  SharedAnswers() = default;
  SharedAnswers(SharedAnswers&& other) noexcept : known_(std::move(other.known_)), computed_(other.computed_) {}

  std::optional<bool> find(const ShapeQuestion& question) const {
    const std::scoped_lock lock(mutex_);
    const auto found = known_.find(question);
    return found == known_.end() ? std::nullopt : std::optional(found->second);
  }
  void add(const ShapeQuestion& question, bool answer) const {
    const std::scoped_lock lock(mutex_);
    known_.emplace(question, answer);
    ++computed_;
  }
  /// Number of answers that were added.
  std::uint64_t computed() const {
    const std::scoped_lock lock(mutex_);
    return computed_;
  }

 private:
  mutable std::mutex mutex_;  // PartMemo hands out constant values
  mutable std::map<ShapeQuestion, bool> known_;
  mutable std::uint64_t computed_ = 0;
};

/// A relation that does not block is a valid straight path past one part, except for the test of convex hulls at its
/// end. Not thread-safe. Idle threads of an executor, if given, compute likely relations speculatively.
class Relations {
  static constexpr double kNothing = std::numeric_limits<double>::infinity();

 public:
  /// All references must outlive this; `executor` may be null.
  Relations(const PairSweep& sweep, const Directions& directions, const Orientations& orientations,
            std::shared_ptr<Executor> executor);

  bool blocks(const Pair& pair);
  /// Computes blocks() of many pairs, in parallel.
  void compute(std::span<const Pair> pairs);
  /// Was the relation asked for before, or is the pair far()? Speculative answers do not count, so that results do not
  /// depend on the number of threads.
  bool known(const Pair& pair) const;
  /// Is it known, and does it block?
  bool known_to_block(const Pair& pair) const;
  /// Are there threads for speculative computation?
  bool works_ahead() const { return blocks_ahead_.computes_ahead(); }
  /// Do these threads have little left to do? Eight questions keep a few threads busy until the next hint.
  bool wants_hints() const { return works_ahead() && blocks_ahead_.waiting() < 8; }
  /// Names pairs that will probably be asked for: each list in order, until a pair of it blocks. Replaces the last
  /// hint.
  void hint(const std::vector<std::vector<Pair>>& lists);
  /// Do boxes alone prove that `moving` does not touch `fixed`?
  bool far(const Pair& pair) const;
  /// Distance along the direction after which `moving` is past `fixed`.
  double distance_past(const Pair& pair) const;
  /// Extent of a part along a direction, rotated but not translated.
  std::pair<double, double> extent(PartId part, std::size_t direction, std::size_t turn = 0) const;
  /// Along the direction and along two across it.
  struct Extents {
    double lo[3] = {kNothing, kNothing, kNothing}, hi[3] = {-kNothing, -kNothing, -kNothing};
    void extend(const Extents& other) {
      for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], other.lo[k]), hi[k] = std::max(hi[k], other.hi[k]);
    }
  };
  /// Those of a part, rotated and translated. far() is decided by the same numbers but for rounding.
  Extents extents_at(PartId part, std::size_t direction, std::size_t turn, const Eigen::Vector3d& at) const;
  /// Number of relations that were asked for.
  std::uint64_t computed() const { return blocks_.size(); }

 private:
  using Shadow = Extents;
  using Key = RelationKey;
  Key key_of(const Pair& pair) const;
  using Ahead = SpeculativeCache<ShapeQuestion, bool>;
  ShapeQuestion question_of(const Pair& pair) const;
  ShapeQuestion as_asked(const Pair& pair) const;
  Ahead::Request request(const ShapeQuestion& question) const;
  Shadow scene(PartId part, std::size_t direction, const Eigen::Matrix3d& turn) const;
  const Shadow& shadow(PartId part, std::size_t direction, std::size_t turn) const;

  const Directions& directions_;
  const PairSweep& sweep_;
  double grid_;  // offsets are rounded to multiples of this: far below the tolerance, above rounding errors
  std::vector<Eigen::Matrix3d> frames_;               // by direction: rows are the direction and two across it
  mutable std::vector<std::vector<Shadow>> shadows_;  // by direction, by part; filled when first asked for
  const Orientations& orientations_;
  mutable std::map<std::tuple<std::size_t, std::size_t, PartId>, Shadow> rotated_shadows_;  // turn, direction, part
  std::map<Key, bool> blocks_;
  const SharedAnswers& answers_;
  std::shared_ptr<Executor> executor_;
  Ahead blocks_ahead_;
};

}  // namespace dismantle::blocking
