#include "reached.h"

#include "dismantle/part_set.h"
#include "dismantle/verification/valid_stretch.h"

namespace dismantle {

void set_reached(Plan& plan, const Disassembly& disassembly, const Verifier& verifier, const RunContext& context) {
  for (std::size_t i = 0; i < disassembly.steps().size(); ++i) {
    const DisassemblyStep& step = disassembly.steps()[i];
    if (!step.forced) continue;
    std::vector<PlacedPart> fixed;
    for (PartId id = 0; id < disassembly.parts(); ++id)
      if (disassembly.group(id, i) == disassembly.left_group(i) && !contains(step.parts, id))
        fixed.push_back({id, disassembly.pose(id, i)});
    plan.disassembly[i].transfer = last_valid_instant(verifier, step.parts, fixed, *step.path, context);
  }
}

}  // namespace dismantle
