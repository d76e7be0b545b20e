#include "best_order/least_cost.h"

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "dismantle/geometry/numerics.h"
#include "dismantle/ordering/class_changes.h"
#include "dismantle/part_set.h"

namespace dismantle::order {

namespace {

using Eigen::Vector3d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostQuestions = 100000;  // bounds the time: those of checks beyond it count as nothing

/// The variants of a segment as questions of what reads nothing but the motion.
class Motions {
 public:
  Motions(Segment& segment, const SequenceQuery& query, RunContext& context)
      : query_(query), context_(context), ups_(1, query.objective.up) {
    for (std::size_t u = 0; u < segment.units(); ++u)
      for (const VariantId v : segment.variants_of(u)) {
        const Motion& motion = segment.motion(v);
        if (all_.size() <= v) all_.resize(v + 1);
        One& one = all_[v];
        for (const PlacedPart& p : segment.start())
          if (contains(motion.parts, p.part)) one.moving.push_back(p);
        one.course = number_of(courses_, motion.insertion);
        one.up = number_of(ups_, segment.up(v).value_or(query.objective.up));
      }
  }

  std::size_t size() const { return all_.size(); }
  std::size_t course(VariantId v) const { return all_[v].course; }
  /// What the check may remember of a step.
  std::pair<std::size_t, std::size_t> memory(const StepCheckTraits& traits, VariantId v) const {
    return {traits.remembers_direction ? all_[v].course : 0, traits.remembers_orientation ? all_[v].up : 0};
  }
  double cost(const ObjectiveItem& item, VariantId v, VariantId previous) const {
    if (previous == kNone) return cost_by(item, question(v, nullptr), &StepCheck::judge, context_);
    const StepQuestion before = question(previous, nullptr);
    return cost_by(item, question(v, &before), &StepCheck::judge, context_);
  }

 private:
  struct One {
    std::vector<PlacedPart> moving;
    std::size_t course = 0, up = 0;
  };
  static std::size_t number_of(std::vector<Vector3d>& list, const Vector3d& v) {
    const auto known = std::find_if(list.begin(), list.end(), [&](const Vector3d& other) {
      return v.dot(other) > geometry::kSameDirection || (v.isZero() && other.isZero());
    });
    const auto number = static_cast<std::size_t>(known - list.begin());
    if (known == list.end()) list.push_back(v);
    return number;
  }
  StepQuestion question(VariantId v, const StepQuestion* previous) const {
    const One& one = all_[v];
    return {query_.assembly, one.moving, {}, courses_[one.course], nullptr, ups_[one.up], previous};
  }

  const SequenceQuery& query_;
  RunContext& context_;
  std::vector<One> all_;
  std::vector<Vector3d> courses_, ups_;
};

struct Least {
  std::vector<double> own;  ///< by variant, after any step
  double change = 0;        ///< at least so much more after a step of another course
};

Least least_of(const Motions& motions, const Objective& objective) {
  Least least{std::vector<double>(motions.size(), 0), kInfinite};
  std::vector<double> more(motions.size(), 0);
  std::size_t asked = 0;
  for (const ObjectiveItem& item : objective.items) {
    const StepCheckTraits traits = item.check->traits();
    if (traits.reads_present || traits.reads_path || traits.remembers_shape || traits.estimates) continue;
    std::map<std::pair<std::size_t, std::size_t>, VariantId> earlier;  // one for each thing that it may remember
    for (VariantId v = 0; v < motions.size(); ++v) earlier.try_emplace(motions.memory(traits, v), v);
    asked += motions.size() * (earlier.size() + 1);
    if (asked > kMostQuestions) continue;
    for (VariantId v = 0; v < motions.size(); ++v) {
      double like = motions.cost(item, v, kNone), other = kInfinite;
      for (const auto& [key, previous] : earlier) {
        const bool same = !traits.remembers_direction || motions.course(previous) == motions.course(v);
        (same ? like : other) = std::min(same ? like : other, motions.cost(item, v, previous));
      }
      const double own = std::min(like, other);
      if (own > 0) least.own[v] += item.weight * own;
      if (traits.remembers_direction && other > own) more[v] += item.weight * (other - own);
    }
  }
  for (const double m : more) least.change = std::min(least.change, m);
  if (!(least.change < kInfinite)) least.change = 0;
  return least;
}

}  // namespace

double least_cost(Segment& segment, const SequenceQuery& query, RunContext& context, Effort& effort) {
  const Motions motions(segment, query, context);
  const Least least = least_of(motions, query.objective);
  const Task task = segment.task();
  double sum = 0, most = 0;
  for (std::size_t u = 0; u < segment.units(); ++u) {
    if (!segment.leaves_alone(u) || (task.end == End::exactly && task.goal.contains(u))) continue;
    double own = kInfinite;
    for (const VariantId v : segment.variants_of(u)) own = std::min(own, least.own[v]);
    if (!(own < kInfinite)) continue;  // it is the one that stays
    sum += own;
    most = std::max(most, own);
  }
  if (task.end == End::one_left) sum -= most;
  if (!(least.change > 0)) return sum;
  const std::size_t changes = least_class_changes(
      segment, task, [&](VariantId v) { return motions.course(v); }, effort);
  return segment.unsure() ? sum : sum + static_cast<double>(changes) * least.change;
}

}  // namespace dismantle::order
