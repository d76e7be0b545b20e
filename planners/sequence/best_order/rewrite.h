/// From a plan to segments that can be put in another order, and back.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "best_order/segment.h"

namespace dismantle::order {

/// A step that is to be recorded: one of the first plan, or a variant.
struct Step {
  const Removal* planned = nullptr;  ///< its path is used if `segment` is null or says so
  const Segment* segment = nullptr;
  VariantId variant = kNone;
};

/// A row of steps: a segment, or steps that keep their order.
struct Block {
  std::unique_ptr<Segment> segment;
  std::vector<const Removal*> fixed;
};

/// Splits a plan. Steps of one group come before those of the groups that it made, in the order of their making. What
/// moves parts and leaves them in their group stays where it is in its group, and if a group begins with such moves,
/// the first separation stays the one that they lead to; from the first forced step of a group on everything of that
/// group and of those that it makes comes last of all, in the order of the plan.
std::vector<Block> blocks_of(const std::vector<Removal>& plan, OrderScene& scene);

/// The steps of the plan that take parts out of the group of the target, up to the one that takes the target out.
/// `whole`: these are all steps that are needed, and each of them is one that a search can put elsewhere.
struct StepsToTarget {
  std::vector<const Removal*> steps;
  bool whole = false;
};
StepsToTarget steps_to_target(const std::vector<Removal>& plan, const SequenceQuery& query);

/// Drops what is said about parts where they lie in no step of these: groups that leave in another order end elsewhere.
/// `before`: the removals that `result` was made with.
void drop_what_is_elsewhere(const std::vector<Removal>& before, const Disassembly& done, const SequenceQuery& query,
                            SequenceResult& result);

/// Cost of a plan, as the engine judges it. `by_check`: without the weights, in the order of the objective.
double cost_of(const std::vector<Removal>& plan, const SequenceQuery& query, const RunContext& context,
               std::vector<double>* by_check = nullptr);
/// The same, if it is not more than `most`; otherwise any larger number. What is quick to find out is asked first.
double cost_within(double most, const std::vector<Removal>& plan, const SequenceQuery& query,
                   const RunContext& context);
/// The same by estimates, and with the whole lying with `up` (unit) upwards all the time. What costs more than `most`
/// is not asked to the end: the answer is larger then. Of a long plan, some steps stand for all.
double estimate_of(const std::vector<Removal>& plan, const SequenceQuery& query, const Eigen::Vector3d& up, double most,
                   const RunContext& context);

/// Does the step take parts out of their group for good, without force?
bool is_plain(const Removal& removal);

/// A removal that the oracle has accepted, in the state `now`, along a straight line; for a refusal its parts are
/// empty. `direction`: of OrderScene::directions.
Removal straight_out(std::vector<PartId> parts, std::size_t direction, const std::optional<Eigen::Vector3d>& up,
                     const Disassembly& now, OrderScene& scene);
/// The same for a step that is known.
Removal verified(const Step& step, const Disassembly& now, OrderScene& scene, std::vector<PartId>& blocked_by);

}  // namespace dismantle::order
