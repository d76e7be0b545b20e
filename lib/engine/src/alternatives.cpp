#include "alternatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "dismantle/engine/judgement.h"
#include "dismantle/part_set.h"
#include "whole_plan.h"

namespace dismantle {

namespace {

constexpr std::size_t kDearest = 5;  // steps that are looked at
constexpr std::size_t kReach = 8;    // places on each side of a step
constexpr std::size_t kMost = 1500;  // steps of a plan: each order is made anew, which grows with their square
/// Judged operations, for checks with estimates: their judgement is expensive. One for this many steps of the plan, and
/// those of two neighbours that change places.
constexpr std::size_t kStepsPerJudged = 4, kLeastJudged = 6;
constexpr std::size_t kNoStep = std::numeric_limits<std::size_t>::max();
constexpr double kRounding = 1e-9;

/// The order of a plan with one step at the place of another. Places are from 0, in the disassembly.
struct Moved {
  std::size_t step, place;

  /// The step at a place.
  std::size_t at(std::size_t p) const {
    if (p == place) return step;
    if (step < place) return p < step || p > place ? p : p + 1;
    return p < place || p > step ? p : p - 1;
  }
  std::size_t distance() const { return step < place ? place - step : step - place; }
  /// The places whose operations may be others than in the plan, from the first one to the last one.
  std::size_t first() const { return std::max<std::size_t>(std::min(step, place), 1) - 1; }
  std::size_t last() const { return std::max(step, place); }
};

/// One operation of such an order, as far as checks may tell it from that of the plan.
struct Changed {
  std::size_t place, step;
  std::size_t previous;  ///< the operation before it, in the order of assembly
  std::size_t side;      ///< of the moved step: its place; of others: 1 if the moved step is now on their other side
  bool other_present;
};

class OtherPlaces {
 public:
  OtherPlaces(const Plan& plan, const Disassembly& done, const std::vector<std::vector<std::size_t>>& needed,
              const Assembly& assembly, const Objective& objective, const Constraints& constraints,
              const RunContext& context)
      : plan_(plan),
        done_(done),
        needed_(needed),
        assembly_(assembly),
        objective_(objective),
        constraints_(constraints),
        context_(context),
        left_(std::max(kLeastJudged, done.steps().size() / kStepsPerJudged)) {
    starts_.resize(done.start_groups());
    for (PartId id = 0; id < done.parts(); ++id)
      if (const std::size_t g = done.group(id, 0); g < starts_.size()) starts_[g].push_back({id, done.pose(id, 0)});
  }

  std::vector<PlanAlternative> found() {
    std::vector<PlanAlternative> all;
    for (const std::size_t step : dearest()) {
      if (context_.should_stop()) return {};
      known_.clear();
      add_cheapest(step, all);
    }
    return all;
  }

 private:
  struct Answer {
    StepVerdict estimated;
    std::optional<StepVerdict> judged{};
  };

  double cost_of(std::size_t step) const {
    double sum = 0;
    for (const PlanVerdict& v : plan_.disassembly[step].checks) sum += v.weight * v.cost;
    return sum;
  }

  std::vector<std::size_t> dearest() const {
    std::vector<std::size_t> all;
    for (std::size_t k = 0; k < done_.steps().size(); ++k)
      if (may_move(k) && cost_of(k) > 0) all.push_back(k);
    std::ranges::stable_sort(all, [&](std::size_t a, std::size_t b) { return cost_of(a) > cost_of(b); });
    all.resize(std::min(all.size(), kDearest));
    return all;
  }

  /// Does it take all of its parts out, so that the others neither notice nor need to know when? With a target, the
  /// last step takes it out.
  bool may_move(std::size_t k) const {
    const DisassemblyStep& step = done_.steps()[k];
    return !step.forced && !step.placement && !step.released && !(constraints_.target && k + 1 == done_.steps().size());
  }

  /// May two steps change places that follow each other?
  bool may_swap(std::size_t first, std::size_t then) const {
    if (!may_move(first) || !may_move(then)) return false;
    if (std::ranges::find(needed_[then], first) != needed_[then].end()) return false;
    return std::ranges::none_of(constraints_.before, [&](const auto& pair) {
      return contains(done_.steps()[first].parts, pair.first) && contains(done_.steps()[then].parts, pair.second);
    });
  }

  std::vector<Moved> places_of(std::size_t step) const {
    std::vector<Moved> all;
    for (std::size_t d = 1; d <= kReach && d <= step && may_swap(step - d, step); ++d) all.push_back({step, step - d});
    for (std::size_t d = 1; d <= kReach && step + d < done_.steps().size() && may_swap(step, step + d); ++d)
      all.push_back({step, step + d});
    return all;
  }

  /// The cheapest place; and where it costs as much there, the cheapest of those that cost otherwise.
  void add_cheapest(std::size_t step, std::vector<PlanAlternative>& to) {
    std::vector<std::pair<double, Moved>> places;
    for (const Moved& m : places_of(step))
      if (const std::optional<double> more = estimate(m)) places.emplace_back(*more, m);
    std::ranges::stable_sort(places, {}, [](const auto& place) {
      return std::pair(std::round(place.first / kRounding), place.second.distance());
    });
    bool equal = false;
    for (const auto& [more, m] : places) {
      const std::size_t needs = judged_operations(m);
      if (needs > left_ || (equal && std::abs(more) <= kRounding)) continue;
      left_ -= needs;
      if (auto one = judge(m)) to.push_back(std::move(*one));
      if (equal || std::abs(more) > kRounding) return;
      equal = true;
    }
  }

  /// Operations that the checks with estimates have to judge.
  std::size_t judged_operations(const Moved& m) const {
    std::size_t count = 0;
    for (const Changed& c : changes_of(m))
      count += std::ranges::any_of(objective_.items, [&](const ObjectiveItem& item) {
        return item.check->traits().estimates && notices(item, c);
      });
    return count;
  }

  std::vector<Changed> changes_of(const Moved& m) const {
    std::vector<Changed> all;
    for (std::size_t p = m.first(); p <= m.last(); ++p) {
      const std::size_t step = m.at(p), next = p + 1 < done_.steps().size() ? m.at(p + 1) : kNoStep;
      Changed c{p, step, next, 0, false};
      if (step == m.step) {
        c.side = m.place;
        c.other_present = true;
      } else {
        c.other_present = (m.step > step) != (m.place > p) && done_.left_group(step) == done_.left_group(m.step);
        c.side = c.other_present ? 1 : 0;
      }
      all.push_back(c);
    }
    return all;
  }

  /// Can the check tell the operation from that of the plan?
  bool notices(const ObjectiveItem& item, const Changed& c) const {
    const StepCheckTraits traits = item.check->traits();
    if (c.other_present && traits.reads_present) return true;
    const std::size_t before = c.step + 1 < done_.steps().size() ? c.step + 1 : kNoStep;
    if (c.previous == before) return false;
    if (c.previous == kNoStep || before == kNoStep || traits.remembers_direction || traits.remembers_shape) return true;
    return traits.remembers_orientation && !up_of(c.previous).isApprox(up_of(before), kRounding);
  }

  Eigen::Vector3d up_of(std::size_t step) const { return done_.steps()[step].up.value_or(objective_.up); }

  /// How much more the order costs by estimates; none: it is not allowed, or not judged.
  std::optional<double> estimate(const Moved& m) {
    double more = 0;
    for (std::size_t i = 0; i < objective_.items.size(); ++i) {
      const ObjectiveItem& item = objective_.items[i];
      for (const Changed& c : changes_of(m)) {
        if (!notices(item, c)) continue;
        const Answer *now = answer(i, m, c), *then = answer(i, {c.step, c.step}, as_planned(c.step));
        if (now == nullptr || then == nullptr || (item.require && !now->estimated.allowed)) return std::nullopt;
        more += item.weight * (now->estimated.cost - then->estimated.cost);
      }
    }
    return more;
  }

  Changed as_planned(std::size_t step) const {
    return {step, step, step + 1 < done_.steps().size() ? step + 1 : kNoStep, kNoStep, false};
  }

  /// What the check says of an operation; null: it failed.
  Answer* answer(std::size_t item, const Moved& m, const Changed& c, bool judged = false) {
    const StepCheck& check = *objective_.items[item].check;
    const auto key = std::tuple(item, c.step, c.previous, c.side);
    auto known = known_.find(key);
    judged = judged && check.traits().estimates;
    if (known != known_.end() && (!judged || known->second.judged)) return &known->second;
    const Disassembly& order = in_order(m);
    const Operation now = operation_of(order, c.place, assembly_, objective_.up);
    std::optional<Operation> before;
    if (c.previous != kNoStep) before.emplace(operation_of(order, c.place + 1, assembly_, objective_.up));
    const std::optional<StepQuestion> earlier = before ? std::optional(before->question()) : std::nullopt;
    const StepQuestion question = now.question(earlier ? &*earlier : nullptr);
    try {
      if (known == known_.end()) known = known_.emplace(key, Answer{check.estimate(question, context_)}).first;
      if (judged) known->second.judged = check.judge(question, context_);
    } catch (const std::exception& e) {
      log_failure(objective_.items[item], e);
      return nullptr;
    }
    return &known->second;
  }

  /// Such an order is not stated. The plan itself was judged without a failure.
  void log_failure(const ObjectiveItem& item, const std::exception& e) const {
    context_.log(LogLevel::warning, fmt::format("step check '{}' threw about another order: {}", item.id, e.what()));
  }

  const Disassembly& in_order(const Moved& m) {
    if (m.step == m.place) return done_;
    if (!order_ || order_of_.step != m.step || order_of_.place != m.place) {
      order_.emplace(done_.parts(), starts_);
      for (std::size_t p = 0; p < done_.steps().size(); ++p) order_->add(done_.steps()[m.at(p)]);
      order_of_ = m;
    }
    return *order_;
  }

  std::optional<PlanAlternative> judge(const Moved& m) {
    PlanAlternative out{static_cast<unsigned>(m.step + 1), static_cast<unsigned>(m.place + 1), {}};
    for (std::size_t i = 0; i < objective_.items.size(); ++i) {
      const ObjectiveItem& item = objective_.items[i];
      PlanVerdict verdict{.type = item.id, .weight = item.weight};
      double more = 0, most = kRounding;
      const auto add = [&](const StepVerdict& now, double then) {
        if (!(now.cost >= 0) || !std::isfinite(now.cost) || (item.require && !now.allowed)) return false;
        const double rise = now.cost - then;
        verdict.allowed = verdict.allowed && now.allowed;
        more += rise;
        if (rise <= most) return true;
        most = rise;
        verdict.reason = now.reason.empty() && !now.notes.empty() ? now.notes.front().text : now.reason;
        return true;
      };
      for (const Changed& c : changes_of(m)) {
        if (!notices(item, c)) continue;
        const Answer* now = answer(i, m, c, true);
        if (now == nullptr ||
            !add(now->judged ? *now->judged : now->estimated, plan_.disassembly[c.step].checks[i].cost))
          return std::nullopt;
      }
      const PlanObjectiveItem& stated = plan_.objective.checks[i];
      if (stated.plan) try {
          if (!add(item.check->judge_plan(WholePlan(in_order(m), assembly_, objective_.up).all(), context_),
                   stated.plan->cost))
            return std::nullopt;
        } catch (const std::exception& e) {
          log_failure(item, e);
          return std::nullopt;
        }
      verdict.cost = std::max(0.0, stated.cost + (std::abs(more) > kRounding ? more : 0));
      out.checks.push_back(std::move(verdict));
    }
    return out;
  }

  const Plan& plan_;
  const Disassembly& done_;
  const std::vector<std::vector<std::size_t>>& needed_;
  const Assembly& assembly_;
  const Objective& objective_;
  const Constraints& constraints_;
  const RunContext& context_;
  std::size_t left_;  // operations that may still be judged
  std::vector<std::vector<PlacedPart>> starts_;
  std::map<std::tuple<std::size_t, std::size_t, std::size_t, std::size_t>, Answer> known_;  // for one moved step
  std::optional<Disassembly> order_;
  Moved order_of_{0, 0};
};

/// Could a check not judge a step, or the plan?
bool was_judged(const Plan& plan) {
  const auto failed = [](const PlanVerdict& v) { return !v.failed.empty(); };
  return std::ranges::none_of(plan.objective.checks, [&](const auto& c) { return c.plan && failed(*c.plan); }) &&
         std::ranges::none_of(plan.disassembly, [&](const auto& s) { return std::ranges::any_of(s.checks, failed); });
}

}  // namespace

void add_other_places(Plan& plan, const Disassembly& done, const std::vector<std::vector<std::size_t>>& needed,
                      const Assembly& assembly, const Objective& objective, const Constraints& constraints,
                      const RunContext& context) {
  const std::size_t steps = done.steps().size();
  if (!prefers_orders(objective) || steps > kMost || needed.size() < steps || !was_judged(plan)) return;
  for (PlanAlternative& one : OtherPlaces(plan, done, needed, assembly, objective, constraints, context).found())
    plan.objective.alternatives.push_back(std::move(one));
}

void add_first_order(Plan& plan, std::map<std::string, double>& counts) {
  PlanAlternative first;
  std::size_t known = 0;
  for (const PlanObjectiveItem& item : plan.objective.checks) {
    const auto cost = counts.extract(fmt::format("first_order.{}", first.checks.size()));
    known += cost.empty() ? 0 : 1;
    first.checks.push_back({.type = item.type, .weight = item.weight, .cost = cost.empty() ? 0 : cost.mapped()});
  }
  if (known > 0 && known == first.checks.size()) plan.objective.alternatives.push_back(std::move(first));
}

}  // namespace dismantle
