/// The least number of bodies that must be held so that a pile stands.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/statics/verdict.h"

namespace dismantle::statics {

/// Bodies that do not stand although everything else is held; so one of them must be held.
struct HoldGroup {
  std::vector<std::uint32_t> bodies{};
  Motions
      motion{};  ///< how they fall: of all bodies of the pile, zero for others; empty: it is not proved that they do
};

/// Result of least_holds().
struct Holds {
  bool found = false;                 ///< with `held` fixed the pile stands
  bool proved = false;                ///< no fewer do: each of the groups falls, with a certificate
  std::vector<std::uint32_t> held{};  ///< ascending
  std::vector<HoldGroup> groups{};    ///< one of each must be held; no smaller set meets all of them
  ContactForces forces{};             ///< that balance the pile with `held` fixed
  Motions displacement{};             ///< that goes with them, as in Judgement
};

/// Judgements of small piles, so that what does not change from one state to the next is judged once. An answer depends
/// on the pile alone, not on who asks first. May be used from several threads.
class DISMANTLE_API KnownJudgements {
 public:
  Judgement of(const Pile& pile, bool by_forces, const std::function<bool()>& stop);

 private:
  std::mutex mutex_;
  std::map<std::vector<double>, Judgement> known_;
};

/// A held body does not move. A minimum set that meets all groups either stands or gives another group.
DISMANTLE_API Holds least_holds(const Pile& pile, const std::function<bool()>& stop = {},
                                KnownJudgements* known = nullptr);

/// The same where a pile counts as standing if forces in equilibrium exist (judge_forces()) and each body stands by
/// itself, in the sense of judge(), when the others do not move, and so does each of the hanging_groups(). Faster; it
/// may take several bodies that are wedged together along slopes for standing.
DISMANTLE_API Holds least_holds_by_forces(const Pile& pile, const std::function<bool()>& stop = {},
                                          KnownJudgements* known = nullptr);

/// The bodies that move, in groups that touch.
DISMANTLE_API std::vector<std::vector<std::uint32_t>> moving_groups(const Pile& pile, const Motions& motion);

/// Groups of two or more bodies that touch and that nothing pushes up but they themselves: no chain of contacts that
/// are not vertical leads to them from what is fixed. They may only be wedged together.
DISMANTLE_API std::vector<std::vector<std::uint32_t>> hanging_groups(const Pile& pile);

/// A smallest set that meets every group; the same one for the same groups.
DISMANTLE_API std::vector<std::uint32_t> minimum_hitting_set(const std::vector<std::vector<std::uint32_t>>& groups);

}  // namespace dismantle::statics
