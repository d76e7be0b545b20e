/// Conversion of a disassembly to the plan that is written: names and input units.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/disassembly.h"
#include "dismantle/engine/run.h"
#include "dismantle/plan.h"
#include "oracle.h"

namespace dismantle {

/// The deepest contact of a part at pose `at` with each other part of its group; ascending by the other part.
using ContactsOf = std::function<std::vector<Contact>(PartId part, const Pose& at)>;

/// With names, and poses on input coordinates.
PlanCertificate to_plan(const Certificate& certificate, const Assembly& assembly);

/// Sets plan.unsolved, and adds their proofs to plan.certificates. `places` may be empty: then the contacts at the best
/// poses are not known.
void set_unsolved(Plan& plan, const std::vector<Unsolved>& unsolved, const Assembly& assembly,
                  const Disassembly& disassembly, const Oracle& oracle, const ContactsOf& places);

/// Adds further proofs to plan.certificates.
void state_proofs(Plan& plan, const std::vector<const Certificate*>& proofs, const Assembly& assembly);

/// Sets `after` and `layer` of the disassembly steps; as needed_steps().
void set_needed(Plan& plan, const std::vector<std::vector<std::size_t>>& needed);

/// The step run backwards (Algorithm 3 from the disassembled poses).
PlanStep reversed(const PlanStep& step);

}  // namespace dismantle
