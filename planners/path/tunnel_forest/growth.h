/// The forests of one query, translating and turning, that grow by turns.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "forest.h"

namespace dismantle::tunnel_forest {

/// What the simulator has to be capable of.
inline constexpr Capabilities kNeeds{.dynamics = true, .distance = true};
inline constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

class Growth {
 public:
  /// All three outlive this.
  Growth(const Parameters& parameters, const PathQuery& query, RunContext& context);

  /// Goes on where the last call stopped, until so many steps were simulated in all calls together. `depth_limit`: that
  /// is the case; `exhausted`: the judge has refused too much, or nothing new is seen any more.
  /// ... or until `pause_at`.
  PathResult run(std::uint64_t until, const Deadline& pause_at = {});
  /// Simulated so far.
  std::uint64_t used() const;

 private:
  struct Grown {
    std::unique_ptr<Forest> forest;
    std::uint64_t turn;  ///< steps of the next one
    std::size_t cells = 0;
    unsigned barren = 0;  ///< turns in a row in which it saw nothing new
    bool relaxed = false;
  };

  void add(MotionSpace motion, std::uint64_t stream);
  bool take_turn(Grown& grown, PathResult& result);
  bool halted() const;
  bool stopped() const;
  bool given_up() const;
  bool over() const { return stopped() || given_up(); }
  void say_why(PathResult& result) const;
  void finish(PathResult& result) const;

  const Parameters parameters_;
  const PathQuery& query_;
  RunContext& context_;
  Deadline deadline_;
  std::vector<Grown> forests_;
  std::size_t next_ = 0;  ///< whose turn it is
  std::uint64_t until_ = 0;
  Deadline pause_at_;
};

}  // namespace dismantle::tunnel_forest
