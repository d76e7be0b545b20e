#include "least_cut/comparison.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace dismantle::least_cut {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kClearlyLess = 0.95;
constexpr double kOfResult = 0.01;  // resolution of the depths that decide, as a share of them
constexpr double kEqualSums = 1.1;  // of sums up to this factor the number of steps decides

bool cuts_less(const Choice& a, const Choice& b) { return a.excess() < b.excess(); }

bool same_parts(const Choice& a, const Choice& b) { return ids_of(a.motion.moving) == ids_of(b.motion.moving); }

}  // namespace

bool Outlook::better_than(const Outlook& other) const {
  if (steps == other.steps) return depth < other.depth;
  return steps < other.steps ? depth <= kEqualSums * other.depth : kEqualSums * depth < other.depth;
}

/// A depth that was compared, not measured, may be this in truth.
double Comparison::unsure(double excess) const {
  return excess + std::max(params_.depth_resolution * tolerance_, params_.depth_share * excess);
}

/// Does `b` stand for `a`? A direction of a sample does not stand for the axis of a feature near it: along the axis a
/// peg may cut in by its press fit, beside it by half of its wall.
bool Comparison::alike(const ForcedMotion& a, const ForcedMotion& b) const {
  return (a.sampled || !b.sampled) && a.straight() && b.straight() &&
         a.twist.linear.dot(b.twist.linear) > params_.set_similarity;
}

/// The motions to measure first: the most promising ones of each set of parts, in distinct directions.
std::vector<const ForcedMotion*> Comparison::chosen(const std::vector<ForcedMotion>& all) const {
  std::map<std::vector<PartId>, std::vector<const ForcedMotion*>> of_set;
  for (const ForcedMotion& m : all) of_set.try_emplace(ids_of(m.moving));
  if (of_set.empty()) return {};
  const std::size_t most = std::max<std::size_t>(params_.set_candidates, params_.candidates / of_set.size());
  std::vector<const ForcedMotion*> list;
  for (const ForcedMotion& m : all) {
    std::vector<const ForcedMotion*>& same = of_set[ids_of(m.moving)];
    const auto like = [&](const ForcedMotion* other) { return alike(m, *other); };
    if (same.size() >= most || std::any_of(same.begin(), same.end(), like)) continue;
    same.push_back(&m);
    list.push_back(&m);
    if (list.size() == params_.candidates) break;
  }
  return list;
}

/// Those that rays do not show to be deeper than `enough`, with what rays show; the least first.
std::vector<std::pair<double, const ForcedMotion*>> Comparison::not_shown_to_be_deeper(
    const std::vector<ForcedMotion>& all, const std::function<double(const ForcedMotion&)>& enough,
    const RunContext& context) const {
  std::vector<std::pair<double, const ForcedMotion*>> list;
  for (const ForcedMotion& m : all) {
    if (context.should_stop()) break;
    const double most = enough(m);
    const auto shown = motions_.least_depth(m, most);
    if (!shown || shown->excess() < most) list.emplace_back(shown ? shown->excess() : 0, &m);
  }
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return list;
}

/// Motions out of the groups with their depths, least first, without those that are known to be deeper than others.
std::vector<Choice> Comparison::compared(const std::vector<Placed>& groups, const Scope& scope,
                                         const RunContext& context) {
  std::vector<ForcedMotion> all;
  for (const Placed& group : groups)
    for (ForcedMotion& m : motions_.candidates(group, context)) all.push_back(std::move(m));
  std::stable_sort(all.begin(), all.end(),
                   [](const ForcedMotion& a, const ForcedMotion& b) { return a.thickness < b.thickness; });
  std::vector<Choice> list;
  std::map<std::vector<PartId>, double> of_set;
  double least = kInfinite;
  const auto least_of = [&](const ForcedMotion& m) {
    if (scope.limit == 0) return least;
    const auto same = of_set.find(ids_of(m.moving));
    return same == of_set.end() ? scope.limit : std::min(scope.limit, same->second);
  };
  const auto measure = [&](const ForcedMotion& m, double stop_above) {
    if (context.should_stop() || (scope.depths != nullptr && *scope.depths == 0)) return false;
    const MotionDepthOptions options{params_.depth_resolution * tolerance_, params_.depth_share, stop_above,
                                     static_cast<std::uint64_t>(params_.depth_poses)};
    Choice now{m, motions_.depth(m, options, context)};
    if (context.should_stop()) return false;
    if (scope.depths != nullptr) --*scope.depths;
    if (now.excess() > stop_above) return true;  // only a lower bound
    least = std::min(least, now.excess());
    double& of_same = of_set.try_emplace(ids_of(m.moving), now.excess()).first->second;
    of_same = std::min(of_same, now.excess());
    list.push_back(std::move(now));
    return scope.depths == nullptr || least > tolerance_;
  };
  // Of an estimate, of a direction that no feature has, and of what is less promising, only what is clearly less deep
  // is of interest.
  const auto clearly_less = [&](const ForcedMotion& m) { return kClearlyLess * least_of(m); };
  std::vector<const ForcedMotion*> done = chosen(all);
  const bool goes_on = std::all_of(done.begin(), done.end(), [&](const ForcedMotion* m) {
    return measure(*m, scope.depths != nullptr || m->sampled ? clearly_less(*m) : unsure(least_of(*m)));
  });
  if (goes_on && scope.depths == nullptr) {
    std::map<std::vector<PartId>, std::size_t> more;
    for (const auto& [bound, m] : not_shown_to_be_deeper(all, clearly_less, context)) {
      if (bound >= clearly_less(*m) || std::any_of(done.begin(), done.end(), [&](const ForcedMotion* other) {
            return alike(*m, *other) && ids_of(m->moving) == ids_of(other->moving);
          }))
        continue;
      if (more[ids_of(m->moving)]++ >= 2 * params_.set_candidates) continue;
      done.push_back(m);
      if (!measure(*m, clearly_less(*m))) break;
    }
  }
  std::stable_sort(list.begin(), list.end(), cuts_less);
  return list;
}

std::optional<Outlook> Comparison::outlook(const Placed& group, std::size_t& depths, const RunContext& context) {
  if (group.size() < 2) return Outlook{};
  const std::vector<PartId> key = ids_of(group);
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  const std::vector<Choice> list = compared({group}, {0, &depths}, context);
  if (context.should_stop() || depths == 0) return std::nullopt;
  const std::optional<Outlook> sum = list.empty() ? Outlook{} : outlook_after(list.front(), depths, context);
  if (sum) known_.emplace(key, *sum);
  return sum;
}

/// This step included.
std::optional<Outlook> Comparison::outlook_after(const Choice& step, std::size_t& depths, const RunContext& context) {
  Outlook sum;
  if (step.excess() > tolerance_) sum = {step.excess(), 1};
  for (const Placed* rest : {&step.motion.moving, &step.motion.fixed}) {
    const std::optional<Outlook> more = outlook(*rest, depths, context);
    if (!more) return std::nullopt;
    sum = {sum.depth + more->depth, sum.steps + more->steps};
  }
  return sum;
}

/// Those whose outlook is the best, within what compared depths are unsure of; the best first.
std::vector<Choice> Comparison::of_best_outlook(const std::vector<Choice>& list, std::size_t& depths,
                                                const RunContext& context) {
  std::vector<std::pair<Outlook, const Choice*>> sums;
  for (const Choice& choice : list) {
    const auto better = [&](const auto& other) { return choice.excess() > kEqualSums * other.first.depth; };
    if (std::any_of(sums.begin(), sums.end(), better)) break;  // the list ascends
    if (std::any_of(sums.begin(), sums.end(), [&](const auto& other) { return same_parts(choice, *other.second); }))
      continue;
    const std::optional<Outlook> sum = outlook_after(choice, depths, context);
    if (!sum) break;
    sums.emplace_back(*sum, &choice);
  }
  const auto best = std::min_element(sums.begin(), sums.end(),
                                     [](const auto& a, const auto& b) { return a.first.better_than(b.first); });
  if (best == sums.end()) return list;
  std::vector<Choice> result;
  for (const Choice& choice : list)
    if (same_parts(choice, *best->second)) result.push_back(choice);
  for (const auto& [sum, choice] : sums)
    if (choice != best->second && sum.steps <= best->first.steps && sum.depth <= unsure(best->first.depth))
      result.push_back(*choice);
  return result;
}

Choice Comparison::measured(Choice choice, double stop_above, const RunContext& context) {
  const MotionDepthOptions options{.absolute = tolerance_,
                                   .relative = kOfResult,
                                   .stop_above = stop_above,
                                   .most_poses = 2 * static_cast<std::uint64_t>(params_.depth_poses)};
  choice.depth = motions_.depth(choice.motion, options, context);
  choice.measured = !context.should_stop() && (!choice.depth || choice.depth->proved);
  return choice;
}

std::optional<Choice> Comparison::best(const std::vector<Placed>& groups, const RunContext& context) {
  known_.clear();
  std::vector<Choice> list = compared(groups, {}, context);
  if (list.empty()) return std::nullopt;
  // Another step can be better only if more has to be forced after the one that cuts in least.
  if (std::size_t depths = params_.outlook_depths; list.front().excess() > tolerance_) {
    const std::optional<Outlook> greedy = outlook_after(list.front(), depths, context);
    if (greedy && greedy->steps > 1)
      if (const std::vector<Choice> all = compared(groups, {kEqualSums * greedy->depth, nullptr}, context);
          !all.empty() && !context.should_stop())
        list = of_best_outlook(all, depths, context);
  }
  // Those that may be the least are measured to a tolerance.
  std::optional<Choice> best;
  for (std::size_t k = 0; k < list.size() && k < params_.finalists; ++k) {
    if (list[k].excess() > unsure(list.front().excess())) continue;
    Choice now = measured(list[k], best ? best->excess() : kInfinite, context);
    if (context.should_stop()) break;
    if (best && now.excess() >= best->excess()) continue;
    best = std::move(now);
    if (best->excess() <= tolerance_) break;
  }
  return best ? best : list.front();
}

}  // namespace dismantle::least_cut
