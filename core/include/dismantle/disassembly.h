/// A disassembly: its steps, and which parts are together, and where, after each of them. Ids and assembly units.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dismantle/certificate.h"
#include "dismantle/constraints.h"
#include "dismantle/export.h"
#include "dismantle/motion_depth.h"
#include "dismantle/simulator.h"

namespace dismantle {

/// What is known about a step that was forced: no verified path is known for it.
struct ForcedCut {
  MotionDepth deepest;
  bool lower_bound = false;  ///< time ran out while measuring: the true depth is at least that of `deepest`
  std::string reason;        ///< why no verified path is known
  std::shared_ptr<const Certificate> certificate{};  ///< proof that there is none; may be null
};

/// One step: parts of one group move simultaneously.
struct DISMANTLE_API DisassemblyStep {
  std::vector<PartId> parts;         ///< that move, ascending, as the columns of the path
  std::shared_ptr<const Trace> path;  ///< verified, or forced
  bool placement = false;            ///< the parts stay in their group at the last poses of the path
  std::optional<PartId> released{};  ///< only this part leaves; the other moved parts stay in their group
  double max_penetration = 0;        ///< certified bound above the initial overlap
  double seconds = 0;                ///< of the search
  unsigned depth = 0;                ///< actions in the path
  std::string planner{};             ///< id of the planner that found the path
  std::vector<PartId> contacts{};    ///< parts touched along the path
  std::optional<ForcedCut> forced{};
  std::optional<Eigen::Vector3d> up{};  ///< unit; how the assembly lies during the step; none: as Objective::up

  /// Does `part`, which moves, leave its group in this step?
  bool leaves(PartId part) const { return !placement && (!released || *released == part); }
  /// The parts that leave, ascending.
  std::vector<PartId> leaving() const;
};

/// Groups are numbered: first those of the start, then one for each step (group_of_step; empty after a placement).
/// A group keeps the parts that do not leave it. Queries about the past take the number of steps done, `after`.
class DISMANTLE_API Disassembly {
 public:
  static constexpr std::size_t kNow = std::numeric_limits<std::size_t>::max();
  /// Of a part that is in no group.
  static constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();

  /// All parts in one group, as assembled.
  explicit Disassembly(std::size_t parts);
  /// Parts in none of the groups are absent. @throws std::invalid_argument for a part that is unknown or listed twice.
  Disassembly(std::size_t parts, const std::vector<std::vector<PlacedPart>>& groups);

  std::size_t parts() const { return stands_.size(); }
  const std::vector<DisassemblyStep>& steps() const { return steps_; }
  /// @throws std::logic_error when the parts are not together, are not in ascending order, or all of a group would leave.
  void add(DisassemblyStep step);
  /// Takes the last step back.
  void pop();
  /// Takes over the steps of another one with the same start, from the first step on in which they differ. Steps are the
  /// same when they share their path, as a step and its copy do.
  void follow(const Disassembly& other);

  const Pose& pose(PartId part, std::size_t after = kNow) const { return stand(part, after).pose; }
  std::size_t group(PartId part, std::size_t after = kNow) const { return stand(part, after).group; }
  /// The group that the parts of step `k` belonged to before it.
  std::size_t left_group(std::size_t k) const { return group(steps_[k].parts.front(), k); }
  std::size_t start_groups() const { return start_groups_; }
  std::size_t group_of_step(std::size_t k) const { return start_groups_ + k; }
  /// Present members of all groups, ascending; some are empty.
  const std::vector<std::vector<PartId>>& groups() const { return groups_; }
  /// The group that all of these parts are in now, if there is one.
  std::optional<std::size_t> common_group(std::span<const PartId> parts) const;
  std::vector<PlacedPart> placed(std::span<const PartId> parts, std::size_t after = kNow) const;
  /// The other parts of the group of `part`, placed.
  std::vector<PlacedPart> around(PartId part) const;

 private:
  struct Stand {
    std::size_t since = 0;
    Pose pose;
    std::size_t group = 0;
  };
  const Stand& stand(PartId part, std::size_t after) const;

  std::size_t start_groups_ = 1;
  std::vector<DisassemblyStep> steps_;
  std::vector<std::vector<Stand>> stands_;  // by part: at the start, and after each step that moves it
  std::vector<std::vector<PartId>> groups_;
};

/// Groups that are still to be taken apart, placed: not those that the constraints keep together; none when the target
/// is out.
DISMANTLE_API std::vector<std::vector<PlacedPart>> open_groups(const Disassembly& disassembly,
                                                               const Constraints& constraints);
/// Is what was asked for done: every group is one part or is kept together, or the target is out?
DISMANTLE_API bool fulfilled(const Disassembly& disassembly, const Constraints& constraints);

}  // namespace dismantle
