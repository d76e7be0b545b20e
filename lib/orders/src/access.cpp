#include "dismantle/orders/access.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "dismantle/ordering/order_search.h"
#include "dismantle/part_set.h"
#include "removals.h"

namespace dismantle {

namespace {

constexpr std::uint64_t kEffort = 6000;  // judged steps for each part

}  // namespace

PartAccess access_as_planned(PartId part, const Disassembly& plan, const Constraints& constraints) {
  PartAccess access;
  const std::vector<PartId> kept = kept_sets(plan.parts(), constraints);
  for (PartId id = 0; id < plan.parts(); ++id)
    if (kept[id] == kept[part]) access.unit.push_back(id);
  for (std::size_t k = 0; k < plan.steps().size(); ++k) {
    const DisassemblyStep& step = plan.steps()[k];
    if (plan.left_group(k) != plan.group(part, k)) continue;
    access.steps.push_back({step.parts, last_direction(*step.path), step.forced.has_value()});
    std::vector<PartId> with;
    for (PartId id = 0; id < plan.parts(); ++id)
      if (plan.group(id, k + 1) == plan.group(part, k + 1)) with.push_back(id);
    if (kept_together(with, constraints)) return access;
  }
  access.steps.clear();
  return access;
}

struct Access::Impl {
  Impl(const Assembly& assembly, const Disassembly& plan_, const Constraints& constraints_, const Objective& objective_,
       const Verifier& verifier, const RunContext& context_)
      : plan(plan_),
        constraints(constraints_),
        objective(objective_),
        context(context_),
        removals(assembly, plan_, constraints_, objective_, verifier, context_) {}

  PartAccess to(std::size_t unit);
  bool search(std::size_t unit, PartAccess& access);
  order::TargetOrder confirmed(std::size_t unit, double known);

  const Disassembly& plan;
  const Constraints& constraints;
  const Objective& objective;
  const RunContext& context;
  Removals removals;
  std::map<std::size_t, PartAccess> known;
};

/// The cheapest way whose steps are all confirmed; a refusal is known in the next round.
order::TargetOrder Access::Impl::confirmed(std::size_t unit, double known_cost) {
  const order::UnitSet all(removals.units(), true);
  constexpr int kRounds = 16;
  order::TargetOrder found;
  for (int round = 0; round < kRounds; ++round) {
    order::Effort effort{kEffort, [this] { return context.should_stop(); }};
    found = order::order_to(removals, all, unit, known_cost, effort);
    order::UnitSet left = all;
    const bool valid = std::all_of(found.best.variants.begin(), found.best.variants.end(), [&](order::VariantId v) {
      if (!removals.confirm(v, left)) return false;
      left -= removals.leaving(v);
      return true;
    });
    if (valid) return found;
  }
  found.best = {};
  found.complete = false;
  return found;
}

/// False: no way was found.
bool Access::Impl::search(std::size_t unit, PartAccess& access) {
  removals.use_objective(false);
  order::TargetOrder found = confirmed(unit, order::kForbidden);
  access.least_depth = found.bound < order::kForbidden ? static_cast<std::size_t>(std::ceil(found.bound - 1e-6)) : 1;
  if (found.best.variants.empty()) return false;
  if (!removals.exact()) access.least_depth = 1;
  access.optimal = found.best.variants.size() == access.least_depth;
  if (!objective.empty()) {
    removals.use_objective(true);
    order::Task task;
    task.start = order::UnitSet(removals.units(), true);
    const double first = order::cost_of(removals, task, found.best.variants);
    order::TargetOrder cheaper = confirmed(unit, first);
    if (!cheaper.best.variants.empty() && cheaper.best.variants.size() <= found.best.variants.size())
      found.best = cheaper.best;
    else
      found.best.cost = first;
    const double steps = Removals::kStep * static_cast<double>(found.best.variants.size());
    access.cost = std::max(0.0, std::round((found.best.cost - steps) * 1e9) / 1e9);  // 16.1, not 16.09999999999854
    access.cheapest = removals.exact() && cheaper.bound >= found.best.cost - 1e-6;
  }
  for (const order::VariantId v : found.best.variants)
    access.steps.push_back({removals.leaving_parts(v), removals.direction(v), false});
  return true;
}

PartAccess Access::Impl::to(std::size_t unit) {
  const PartAccess planned = access_as_planned(removals.parts_of(unit).front(), plan, constraints);
  PartAccess access;
  const bool found = !context.should_stop() && search(unit, access);
  const bool forced =
      std::any_of(planned.steps.begin(), planned.steps.end(), [](const AccessStep& s) { return s.forced; });
  // Groups that leave with the part are known to the plan only.
  if (!found || (!forced && !planned.steps.empty() && planned.steps.size() < access.steps.size())) {
    access = planned;
  }
  access.unit = planned.unit;
  return access;
}

Access::Access(const Assembly& assembly, const Disassembly& plan, const Constraints& constraints,
               const Objective& objective, const Verifier& verifier, const RunContext& context)
    : impl_(std::make_unique<Impl>(assembly, plan, constraints, objective, verifier, context)) {}
Access::~Access() = default;

PartAccess Access::to(PartId part) {
  const std::size_t unit = impl_->removals.unit_of(part);
  const auto known = impl_->known.find(unit);
  if (known != impl_->known.end()) return known->second;
  PartAccess access = impl_->to(unit);
  if (!impl_->context.should_stop()) impl_->known.emplace(unit, access);
  return access;
}

}  // namespace dismantle
