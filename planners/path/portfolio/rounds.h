/// Members in turns that grow.
#pragma once

#include <cstddef>
#include <cstdint>

#include "dismantle/path_planner.h"
#include "members.h"

namespace dismantle::portfolio {

/// Each member that is ready has one turn in a round.
class Rounds {
 public:
  /// Both arguments outlive this.
  Rounds(Members& members, const Parameters& parameters);

  /// Continues where the last call stopped.
  Decision run(const RunContext& context, Portion& portion);

 private:
  void begin_round();
  bool waits(const MemberSearch& m) const;
  std::uint64_t length_of_turn(const MemberSearch& m) const;
  Decision take_turn(MemberSearch& m, const RunContext& context, Portion& portion);

  Members& members_;
  const Parameters& parameters_;
  std::size_t at_ = 0;            ///< the member whose turn it is
  std::uint64_t turn_;            ///< length of the turns of this round
  std::uint64_t turn_began_ = 0;  ///< work of the member when its turn began
  bool in_turn_ = false;          ///< a portion ended before the turn did
  bool short_round_ = false;      ///< the first member has a short turn
};

}  // namespace dismantle::portfolio
