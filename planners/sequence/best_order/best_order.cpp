#include "best_order/best_order.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <string>
#include <utility>

#include "best_order/around_largest.h"
#include "best_order/by_verdict.h"
#include "best_order/keeper.h"
#include "best_order/least_cost.h"
#include "best_order/rewrite.h"
#include "dismantle/part_set.h"

namespace dismantle {

using order::Block;
using order::CheckFailed;
using order::Effort;
using order::Keeper;
using order::kForbidden;
using order::kSame;
using order::OrderScene;
using order::Segment;
using order::Step;
using order::VariantId;

void BestOrderParameters::describe(Schema<BestOrderParameters>& s) {
  s.add("of", &BestOrderParameters::of, {.doc = "The planner whose plan is put in a better order."});
  s.add("effort", &BestOrderParameters::effort,
        {.unit = "1",
         .min = 0,
         .max = 1e9,
         .doc = "Budget of the search, in judged steps; a tenth of it in tests of pairs of parts. Counted, so that the "
                "plan does not depend on the machine."});
}

namespace {

/// Units up to which A* often ends. Beyond, it is for the bound of the cost only.
constexpr std::size_t kMostForExact = 24;
/// Of the effort: what the first, wider beam gets for a plan of one segment. Beyond kMostForExact, A* has a tenth.
constexpr std::uint64_t kPerVerdict = 5;  // estimates, for each step of the plan: a verdict takes longer for more parts
constexpr std::uint64_t kOfRows = 4;      // cheap questions, whether a unit may leave, for each judged step
constexpr double kWider = 2.0 / 3, kOfBeam = kWider * 0.9 / 2;

blocking::Directions with_used(blocking::Directions directions, const std::vector<Removal>& plan,
                               std::vector<std::size_t>& everywhere) {
  for (std::size_t d = 0; d < 6; ++d) everywhere.push_back(d);
  constexpr std::size_t kMost = 12;
  for (const Removal& removal : plan) {
    const Path& path = removal.attempt->path();
    const Eigen::Vector3d displacement = path.back().front().t - path[path.size() > 1 ? path.size() - 2 : 0].front().t;
    if (removal.attempt->forced || displacement.isZero() || everywhere.size() >= kMost) continue;
    const Eigen::Vector3d unit = displacement.normalized();
    std::size_t d = 0;
    while (d < directions.all.size() && directions.all[d].dot(unit) <= 1 - 1e-9) ++d;
    if (d == directions.all.size()) {
      directions.all.push_back(unit);
      directions.all.push_back(-unit);
    }
    if (std::find(everywhere.begin(), everywhere.end(), d) == everywhere.end()) everywhere.push_back(d);
  }
  return directions;
}

/// Finds the order of each segment, and records it if the whole is better.
class Rewriting {
 public:
  Rewriting(const BestOrderParameters& params, const SequenceQuery& query, PathOracle& oracle, Keeper& keeper,
            RunContext& context, std::vector<Removal> plan)
      : query_(query),
        keeper_(keeper),
        context_(context),
        plan_(std::move(plan)),
        sweep_(oracle.tolerance() > 0 ? std::make_unique<blocking::PairSweep>(query.assembly, oracle) : nullptr),
        directions_(
            with_used(sweep_ ? blocking::directions_of(query.assembly) : blocking::Directions{}, plan_, everywhere_)),
        given_(static_cast<std::uint64_t>(params.effort)),
        effort_{given_, [&context] { return context.should_stop(); }},
        sweeps_{effort_.left / 10, effort_.stop},
        scene_{query, oracle, context, sweep_.get(), directions_, everywhere_, {std::nullopt}, sweeps_} {
    const bool turns = std::any_of(query.objective.items.begin(), query.objective.items.end(),
                                   [](const ObjectiveItem& i) { return i.check->traits().remembers_orientation; });
    for (int axis = 0; turns && axis < 6; ++axis) {
      const Eigen::Vector3d up = (axis % 2 == 0 ? 1 : -1) * Eigen::Vector3d::Unit(axis / 2);
      if (up.dot(query.objective.up) < 1 - 1e-9) scene_.ups.emplace_back(up);
    }
    const auto steps = static_cast<double>(plan_.size());
    if (steps * steps * static_cast<double>(scene_.ups.size()) > params.effort) keep_best_up();
  }

  /// `kept`: what the plan that is kept so far costs, if that is not this one.
  void run(SequenceResult& result, std::optional<double> kept = std::nullopt) {
    const double before = kept ? *kept : order::cost_of(plan_, query_, context_, &by_check_);
    any_order_ = kept.has_value();
    std::vector<Block> blocks = order::blocks_of(plan_, scene_);
    constexpr int kRounds = 4;  // a refusal of the verifier is known in the next one
    // The search estimates what the checks say. Two searches of different width give two orders, and the checks choose.
    // Where they like neither, the estimate has misled the search: a wider one follows, if it has a chance to end.
    double bound = 0;
    for (const double share : {kWider, 1 - kWider, 3.0}) {
      if (share > 1 && (kept || after_ < kForbidden || !worth_it_ || plan_.size() > kMostForExact)) break;
      complete_ = true;
      const Effort own{static_cast<std::uint64_t>(share * static_cast<double>(effort_.left)), effort_.stop};
      for (int round = 0; round < kRounds && !context_.should_stop(); ++round) {
        const std::vector<Step> steps = search(blocks, own);
        if (!worth_it_ || record(steps, std::min(before, after_))) break;
      }
      bound = std::max(bound, bound_);
      if (complete_ || context_.should_stop()) break;
    }
    bound_ = bound;
    by_verdicts(blocks, std::min(before, after_));
    if (kept && !(after_ < kForbidden)) return;
    // Where a check gives estimates, A* says nothing about verdicts.
    if (const double least = std::max(bounded_ ? bound_ : 0, least_of_motions(blocks)); bounded_ || least > kSame)
      result.least_cost = std::min(least, after_ < kForbidden ? after_ : before);
    count(result, before);
  }

  /// Of the plan that is kept now.
  double kept_cost() const { return order::cost_of(keeper_.removals(), query_, context_); }
  /// The plan that is kept now, around its largest part; empty: there is none.
  std::vector<Removal> around_largest() { return order::around_largest(keeper_.removals(), scene_); }

  /// The same for the steps to a target. `solved`: those of the plan take it out.
  void run_to_target(SequenceResult& result, bool solved) {
    const PartId target = *query_.constraints.target;
    const auto group = std::find_if(query_.start.begin(), query_.start.end(),
                                    [&](const std::vector<PlacedPart>& list) { return contains(list, target); });
    if (group == query_.start.end()) return;
    const bool forced =
        std::any_of(plan_.begin(), plan_.end(), [](const Removal& r) { return r.attempt->forced != nullptr; });
    const double before = solved && !forced ? order::cost_of(plan_, query_, context_, &by_check_) : kForbidden;
    const order::StepsToTarget planned = order::steps_to_target(plan_, query_);
    Segment segment(scene_, *group, planned.steps, Segment::ToTarget{});
    constexpr int kRounds = 16;  // a refusal of the verifier is known in the next one
    for (int round = 0; round < kRounds && !context_.should_stop(); ++round) {
      const std::vector<Step> steps = search_to_target(segment, target, planned, before);
      if (!worth_it_ || record(steps, before)) break;
    }
    // The search knows nothing about steps of the plan that it cannot put elsewhere.
    if (after_ < kForbidden || (before < kForbidden && planned.whole))
      result.least_cost = std::min({bound_, before, after_});
    count(result, before);
    if (has_replaced()) state_first_order(result);
  }

  /// Is another order recorded than the one that this was made with?
  bool has_replaced() const { return after_ < kForbidden; }
  /// What the order that this was made with costs, by check; for the engine, which writes it into the plan.
  void state_first_order(SequenceResult& result) const {
    for (std::size_t i = 0; i < by_check_.size(); ++i) result.counts["first_order." + std::to_string(i)] = by_check_[i];
  }

 private:
  void count(SequenceResult& result, double before) const {
    result.counts["order_effort"] += static_cast<double>(spent_);
    result.counts["order_saved"] += before < kForbidden && after_ < kForbidden ? before - after_ : 0;
  }

  /// What no order of the segments' motions can do without. Last of all: it may use up the tests of pairs.
  double least_of_motions(const std::vector<Block>& blocks) const {
    double sum = 0;
    Effort rows{kOfRows * given_, effort_.stop};
    for (const Block& block : blocks)
      if (block.segment) sum += order::least_cost(*block.segment, query_, context_, rows);
    return sum;
  }

  /// Too many steps to try each in each orientation: as drawn, and the one in which the first plan is best all along.
  void keep_best_up() {
    std::optional<Eigen::Vector3d> best;
    double least = kForbidden;
    for (const std::optional<Eigen::Vector3d>& up : scene_.ups) {
      const double cost = order::estimate_of(plan_, query_, up.value_or(query_.objective.up), least, context_);
      if (!(cost < least - kSame)) continue;
      least = cost;
      best = up;
    }
    scene_.ups = {std::nullopt};
    if (best) scene_.ups.push_back(best);
  }

  std::vector<Step> search_to_target(Segment& segment, PartId target, const order::StepsToTarget& planned,
                                     double before) {
    const order::UnitSet all(segment.units(), true);
    const std::vector<VariantId> first = segment.as_planned();
    order::Task task;
    task.start = all;
    const bool whole = before < kForbidden && planned.whole && first.size() == planned.steps.size();
    const double known = whole ? order::cost_of(segment, task, first) : before + segment.most_preference();
    Effort own{effort_.left / 2, effort_.stop};
    const std::uint64_t given = own.left;
    order::TargetOrder found = order::order_to(segment, all, segment.unit_of(target), known, own);
    effort_.left -= given - own.left;
    spent_ += given - own.left;
    worth_it_ = !found.best.variants.empty();
    if (!worth_it_) found.best = {whole ? first : std::vector<VariantId>{}, known};
    // What the checks say of a path is known when the step is planned. Costs that differ by less than the preferences
    // count as equal.
    const double sure = segment.unsure() ? found.floor : segment.exact() ? found.bound : found.least;
    const double slack = segment.most_preference(), cost = found.best.cost - segment.preference(found.best.variants);
    bound_ = cost - sure <= 2 * slack + kSame ? cost : std::max(0.0, sure - slack);
    std::vector<Step> steps;
    if (!worth_it_) return steps;
    for (const VariantId v : found.best.variants) steps.push_back({nullptr, &segment, v});
    return steps;
  }

  std::vector<Step> search(std::vector<Block>& blocks, const Effort& effort) {
    std::vector<Step> steps;
    bound_ = 0;
    worth_it_ = any_order_;
    std::size_t segments = 0;
    for (const Block& block : blocks) segments += block.segment ? 1 : 0;
    for (Block& block : blocks) {
      for (const Removal* removal : block.fixed) steps.push_back({removal, nullptr, order::kNone});
      if (!block.segment) continue;
      Segment& segment = *block.segment;
      Effort own{effort.left / segments, effort.stop};
      const std::uint64_t given = own.left;
      const order::Task task = segment.task();
      const double planned = order::cost_of(segment, task, segment.as_planned());
      order::Order best{segment.as_planned(), planned};
      Effort exact{own.left / (segment.units() <= kMostForExact ? 2 : 10), own.stop};
      const std::uint64_t exact_given = exact.left;
      const order::BestFirst found = order::best_first(segment, task, best.cost, exact);
      own.left = own.left - exact_given + exact.left;
      if (found.best.cost < best.cost) best = found.best;
      complete_ = complete_ && found.complete;
      if (!found.complete) {
        Effort wide{own.left / 2, own.stop};
        const std::uint64_t most = wide.left;
        if (order::Order other = order::beam(segment, task, wide); other.cost < best.cost) best = std::move(other);
        own.left -= most - wide.left;
        order::improve(segment, task, best, own);
      }
      const double sure = segment.unsure() ? order::lower_bound(segment, task, task.start, order::kNone) : found.bound;
      // Costs that differ by less than the preferences count as equal.
      const double slack = segment.most_preference();
      const double cost = best.cost - segment.preference(best.variants), bound = sure - slack;
      bound_ += cost - bound <= 2 * slack + kSame ? cost : std::max(0.0, bound);
      bounded_ = bounded_ && segment.exact();
      worth_it_ = worth_it_ || best.cost < planned - kSame;
      spent_ += given - own.left;
      for (const VariantId v : best.variants) steps.push_back({nullptr, &segment, v});
    }
    return steps;
  }

  /// Estimates mislead where they do not see what a step leaves to be held: once more, by verdicts.
  void by_verdicts(std::vector<Block>& blocks, double known) {
    const bool estimated = std::any_of(query_.objective.items.begin(), query_.objective.items.end(),
                                       [](const ObjectiveItem& i) { return i.check->traits().estimates; });
    if (!estimated || !(known > kSame) || context_.should_stop()) return;
    const std::vector<Step> steps =
        order::by_verdict(blocks, scene_.ups, known, effort_.left / (kPerVerdict * plan_.size()));
    if (!steps.empty()) record(steps, known - 2 * kSame);
  }

  /// False: a step was refused, and is not proposed again.
  bool record(const std::vector<Step>& steps, double before) {
    const std::vector<std::pair<Removal, std::size_t>> old = keeper_.all;
    if (!keeper_.taken_back(old.size())) return true;
    std::vector<Removal> done;
    std::vector<PartId> blocked_by;
    Disassembly now(query_.assembly.parts.size(), query_.start);
    const auto restore = [&] {
      keeper_.taken_back(done.size());
      for (const auto& [removal, left] : old) keeper_.removed(removal, left);
    };
    for (const Step& step : steps) {
      Removal removal = order::verified(step, now, scene_, blocked_by);
      if (removal.parts.empty()) {
        restore();
        if (context_.should_stop() || step.segment == nullptr) return true;
        const_cast<Segment*>(step.segment)->forbid(step.variant, blocked_by);
        return false;
      }
      const std::size_t group = now.group(removal.parts.front());
      now.add(step_of(removal));
      done.push_back(removal);
      keeper_.removed(removal, now.groups()[group].size());
      context_.progress("order", done.size(), steps.size());
    }
    const double cost = order::cost_within(before + kSame, done, query_, context_);
    if (cost < before + kSame) {
      after_ = cost;
    } else {
      restore();
    }
    return true;
  }

  const SequenceQuery& query_;
  Keeper& keeper_;
  RunContext& context_;
  std::vector<Removal> plan_;
  std::vector<std::size_t> everywhere_;
  std::unique_ptr<blocking::PairSweep> sweep_;
  blocking::Directions directions_;
  std::uint64_t given_;
  Effort effort_, sweeps_;
  OrderScene scene_;
  std::uint64_t spent_ = 0;
  std::vector<double> by_check_;  // what plan_ costs; empty: not known, or it is refused
  double bound_ = 0, after_ = kForbidden;
  bool bounded_ = true, worth_it_ = false, complete_ = false;
  bool any_order_ = false;  // also that of plan_ is worth recording
};

/// The order of the plan; then that of the plan around its largest part, if this costs less.
void improve(const BestOrderParameters& params, Rewriting& rewriting, const SequenceQuery& query, PathOracle& oracle,
             Keeper& keeper, RunContext& context, SequenceResult& result) {
  rewriting.run(result);
  if (rewriting.has_replaced()) rewriting.state_first_order(result);
  if (context.should_stop() || params.effort == 0) return;
  const double kept = rewriting.kept_cost();
  if (!(kept > kSame)) return;
  std::vector<Removal> other = rewriting.around_largest();
  if (other.empty()) return;
  BestOrderParameters half = params;
  half.effort /= 2;
  Rewriting around(half, query, oracle, keeper, context, std::move(other));
  around.run(result, kept);
  if (around.has_replaced()) rewriting.state_first_order(result);
}

}  // namespace

BestOrder::BestOrder(const BestOrderParameters& params) : params_(params), inner_(params.of.create()) {
  traits_ = inner_->traits();
  traits_.follows_objective = true;
}

SequenceResult BestOrder::plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                               RunContext& context) {
  // The inner planner looks for any plan: to prefer some removals takes it much longer. What is required it has to
  // know.
  Objective required{{}, query.objective.up};
  for (const ObjectiveItem& item : query.objective.items)
    if (item.require) required.items.push_back(item);
  Keeper keeper(observer, params_.of.type());
  SequenceResult result =
      inner_->plan({query.assembly, query.start, query.constraints, required, query.said}, oracle, keeper, context);
  for (Removal& removal : result.removals)
    if (removal.planner.empty()) removal.planner = params_.of.type();
  const bool to_target = query.constraints.target.has_value();
  if (query.objective.empty() || context.should_stop() || result.outcome == Outcome::crashed) return result;
  if (!to_target && result.removals.size() < 2) return result;
  if (!to_target && result.removals.size() > kMostForExact &&
      static_cast<double>(order::least_effort(result.removals.size())) >
          kOfBeam * static_cast<double>(params_.effort)) {
    context.log(LogLevel::info, "the order is not improved: best_order has too little effort for " +
                                    std::to_string(result.removals.size()) + " steps");
    result.counts["order_effort"] = result.counts["order_saved"] = 0;
    return result;
  }
  // The checks may depend on what the inner planner has announced only, which is what was recorded.
  try {
    Rewriting rewriting(params_, query, oracle, keeper, context, keeper.removals());
    if (to_target)
      rewriting.run_to_target(result, is_success(result.outcome));
    else
      improve(params_, rewriting, query, oracle, keeper, context, result);
  } catch (const CheckFailed& e) {
    context.log(LogLevel::error, std::string("the order is not improved, a step check failed: ") + e.what());
  }
  const std::vector<Removal> before = std::exchange(result.removals, keeper.removals());
  Disassembly done(query.assembly.parts.size(), query.start);
  for (const Removal& removal : result.removals) done.add(step_of(removal));
  order::drop_what_is_elsewhere(before, done, query, result);
  if (to_target && fulfilled(done, query.constraints)) {
    result.outcome = Outcome::solved;
    result.unsolved.clear();
  }
  result.remaining.clear();
  for (const std::vector<PartId>& group : done.groups())
    if (&group == &done.groups().front() || group.size() > 1)
      result.remaining.insert(result.remaining.end(), group.begin(), group.end());
  return result;
}

}  // namespace dismantle
