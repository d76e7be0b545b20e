/// Groups and poses after each step of a plan's disassembly.
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/plan.h"
#include "dismantle/pose.h"

namespace dismantle {

/// A step takes new groups out of one that was together. The rest keeps the number of the group.
struct GroupSplit {
  std::size_t from = 0;
  std::vector<std::size_t> out;  ///< the new groups, in the order of `separates`; not empty
};

/// Who is with whom, and where, after the first `done` steps of Plan::disassembly (0: assembled). All that shows or
/// writes a plan asks here. Parts are indices into PlanAssembly::parts, steps into Plan::disassembly; groups are
/// numbered in the order in which they come to be, and 0 is the one that the first steps take parts from. Needs memory
/// for what changes, not for every part at every step.
///
/// A step that names every part of a group in `separates` leaves the largest piece without a moving part.
class DISMANTLE_API PlanHistory {
 public:
  /// @throws InputError when a step names a part that the assembly of the plan lacks.
  explicit PlanHistory(const Plan& plan);

  std::size_t parts() const { return group_.size(); }
  std::size_t steps() const { return splits_.size(); }
  std::size_t groups() const { return groups_.size(); }
  /// @throws InputError when there is no such part.
  std::size_t index_of(const std::string& part) const;

  /// What a step takes apart. An intermediate placement splits nothing; others split one group (a plan file may say
  /// more).
  const std::vector<GroupSplit>& splits(std::size_t step) const { return splits_.at(step); }
  /// Parts that leave their group in a step.
  std::vector<std::size_t> leaving(std::size_t step) const;
  std::size_t group_of(std::size_t part, std::size_t done) const;
  /// In the order in which they leave the group, the last first. Empty before the group exists.
  std::span<const std::size_t> members(std::size_t group, std::size_t done) const;
  /// Input units.
  Pose pose_of(std::size_t part, std::size_t done) const;

  /// Place of a part in the order in which parts first leave a group; none: it never does.
  std::optional<std::size_t> rank(std::size_t part) const { return rank_.at(part); }
  /// Number of parts with a rank.
  std::size_t leavers() const { return leavers_; }
  /// Step after which a part is out for good: its group is not taken apart any more, is not group 0, and the plan does
  /// not list it as remaining. None: it stays.
  std::optional<std::size_t> out_in(std::size_t part) const { return out_in_.at(part); }

 private:
  template <class Value>
  using Changes = std::vector<std::pair<std::size_t, Value>>;  // number of steps done, value from then on

  struct Group {
    std::size_t since = 0;           // number of steps done when it comes to be
    std::vector<std::size_t> parts;  // the last to leave first
    std::vector<std::size_t> until;  // step in which each of `parts` leaves, or kStays; descending
  };
  static constexpr std::size_t kStays = std::numeric_limits<std::size_t>::max();

  void split(const PlanStep& plan_step, std::size_t step, std::vector<std::vector<std::size_t>>& now);
  void find_out(const Plan& plan);

  std::map<std::string, std::size_t> index_;
  std::vector<Changes<std::size_t>> group_;  // by part; empty at first: group 0
  std::vector<Changes<Pose>> pose_;          // by part
  std::vector<std::vector<GroupSplit>> splits_;
  std::vector<Group> groups_;
  std::vector<std::optional<std::size_t>> rank_, out_in_;
  std::size_t leavers_ = 0;
};

}  // namespace dismantle
