/// index.html: a plan shown in a browser, one file that needs no network.
#pragma once

#include <string>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/explain.h"

namespace dismantle {

/// `page_template` (apps/viewer) with the plan, the parts' surfaces and what is to be shown of them in its placeholder
/// (docs/viewer.md). Parts that are congruent share one surface. `settings`: of the run, for the advice on parts that
/// did not come out. The same arguments give the same bytes.
/// @throws InputError when the plan has a part that the assembly lacks. @throws Error when `page_template` does not
/// have exactly one placeholder.
DISMANTLE_API std::string to_page(const Plan& plan, const Assembly& assembly, const std::string& page_template,
                                  const ExplainSettings& settings = {});

}  // namespace dismantle
