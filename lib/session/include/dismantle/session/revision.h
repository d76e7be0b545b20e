/// A later revision of an assembly: what changed, and what of an earlier plan still holds.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/constraints.h"
#include "dismantle/disassembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// What became of a part. `changed` may also be moved.
enum class PartFate { same, moved, changed, renamed, added, removed };
DISMANTLE_API const char* to_string(PartFate fate);

/// One part of two revisions.
struct PartRevision {
  PartFate fate = PartFate::same;
  std::string before, now;  ///< names; empty where there is no such part
};

/// Compares the parts of two assemblies, in input units. Parts of one name are one part; others are one part, renamed,
/// if one has the shape and the place of the other. In the order of `now`, then the removed ones in that of `before`.
DISMANTLE_API std::vector<PartRevision> revised_parts(const Assembly& before, const Assembly& now);

/// A step of an earlier plan.
struct StepRevision {
  unsigned step = 0;                 ///< number in the earlier plan's disassembly
  std::vector<std::string> parts{};  ///< that it moved there
  bool kept = false;
  std::string reason{};  ///< not kept: why
};

/// The steps of an earlier plan that hold in this assembly.
struct KeptSteps {
  Disassembly steps;
  std::vector<StepRevision> revisions{};  ///< of all steps, in their order
};

/// Goes through the steps of the plan in their order and keeps each one that the verifier accepts with what is there;
/// parts are found by name. A part that is not there any more is left out of its step; one that is new is in the way.
/// Forced steps, and those that the constraints forbid, are not kept. Ends early when `context` wants to stop.
DISMANTLE_API KeptSteps kept_steps(const Plan& plan, const Assembly& now, const Constraints& constraints,
                                   const Verifier& verifier, const RunContext& context);

}  // namespace dismantle
