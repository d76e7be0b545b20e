/// Macro motions: a screw is followed by geometry alone as far as it is clear, and corrected where it meets a surface.
#pragma once

#include <cstdint>

#include "dismantle/geometry/twist.h"
#include "dismantle/push_search/problem.h"
#include "dismantle/push_search/proposals.h"
#include "dismantle/push_search/state_tree.h"
#include "dismantle/push_search/work.h"

namespace dismantle::push {

/// Where a screw is blocked, the part goes back a little and is moved away from its contacts. The screw is fitted to
/// that pose, and the part restarts from its first pose: a thread is one screw, which the verifier proves with the
/// least effort. If the new screw leads no further, the surface has no single screw (a bent tube), and the curve is
/// followed piece by piece.
class ScrewRun {
 public:
  enum class End {
    blocked,  ///< the rest has to be simulated
    out,      ///< the part is separated
    known,    ///< in a known state
    stop,     ///< the work or the time is used up
  };

  /// A run that begins in a state of the tree and adds states of this depth. `short_glides`: the distances between
  /// state checks do not grow. The references must outlive this.
  ScrewRun(Problem& problem, Work& work, StateTree& tree, std::int32_t from, unsigned depth, bool short_glides);

  End follow(const geometry::Twist& screw);
  /// The node that was recorded last.
  std::int32_t last() const { return last_; }
  /// After `blocked`: wrenches that drive the part on along the screw.
  Action onward() const { return along(problem_, screw_, state_); }

 private:
  struct Glide {
    End end;
    double length;
  };
  Glide glide(const geometry::Twist& screw, double clear);
  bool in_known_state(const State& state, const State& start, bool& left) const;
  void record(const geometry::Twist& screw, double length);
  bool turn_back(double kept);
  End finish(double length);
  double travel(const State& a, const State& b) const;

  Problem& problem_;
  Work& work_;
  StateTree& tree_;
  const std::int32_t from_;
  const unsigned depth_;
  const double growth_;        ///< of the distances between state checks, with the clear length
  const std::uint32_t first_;  ///< the first node of the run
  const State origin_;         ///< where the run began
  State state_;
  std::int32_t last_;
  Path motion_;            ///< instants since `last_`
  double length_ = 0;      ///< total length of the glides
  geometry::Twist screw_;  ///< the best one from `state_`
  State room_;             ///< where the part was moved away from its contacts
  double kept_ = 0;        ///< length on `screw_` at which that was
  geometry::Twist screw_in_room_;
};

}  // namespace dismantle::push
