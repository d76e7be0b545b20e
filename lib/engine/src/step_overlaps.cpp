#include "step_overlaps.h"

#include <algorithm>
#include <utility>

#include "dismantle/part_set.h"
#include "dismantle/verification/motion_depth.h"

namespace dismantle {

std::vector<std::vector<PlanStepOverlap>> step_overlaps(const Disassembly& done, const Assembly& assembly,
                                                        const Verifier& verifier, double least,
                                                        const RunContext& context) {
  const std::vector<DisassemblyStep>& steps = done.steps();
  std::vector<std::vector<PlanStepOverlap>> all(steps.size());
  std::vector<const InitialOverlap*> deep;
  for (const InitialOverlap& o : assembly.overlaps)
    if (std::max(o.depth, o.allowed()) > least) deep.push_back(&o);
  if (deep.empty()) return all;

  const double scale = assembly.normalization.scale;
  MotionDepthMeter meter(assembly, verifier);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const DisassemblyStep& step = steps[k];
    if (context.should_stop()) return all;
    for (std::size_t i = 0; i < step.parts.size(); ++i) {
      const PartId part = step.parts[i];
      Path column;
      for (const auto& instant : *step.path) column.push_back({instant[i]});
      for (const InitialOverlap* o : deep) {
        if (o->a != part && o->b != part) continue;
        const PartId other = o->a == part ? o->b : o->a;
        if (contains(step.parts, other) || done.group(other, k) != done.left_group(k)) continue;
        MotionDepthOptions options;
        if (!step.forced)  // the step has been verified
          options.at_most = o->allowed() + verifier.options().max_penetration;
        const auto found = meter.deepest({part}, {{other, done.pose(other, k)}}, column, options, context, true);
        if (!found || found->depth <= 0) continue;
        const Normalization& to = assembly.normalization;
        PlanStepOverlap used{assembly.parts[part].name,
                             assembly.parts[other].name,
                             o->depth / scale,
                             o->allowed() / scale,
                             found->depth / scale,
                             to.to_input(found->point),
                             {}};
        if (const auto region = verifier.overlap_region(part, other))
          used.region = Aabb{to.to_input(region->lo), to.to_input(region->hi)};
        all[k].push_back(std::move(used));
      }
    }
  }
  return all;
}

}  // namespace dismantle
