/// index.html: a plan shown in a browser, one file that needs no network.
#pragma once

#include <string>

#include "dismantle/export.h"
#include "dismantle/assembly.h"
#include "dismantle/plan.h"

namespace dismantle {

/// `page_template` (apps/viewer) with the plan and the parts' surfaces in its placeholder. Parts that are congruent
/// share one surface. The same plan and template give the same bytes.
/// @throws InputError when the plan has a part that the assembly lacks. @throws Error when `page_template` does not
/// have exactly one placeholder.
DISMANTLE_API std::string to_page(const Plan& plan, const Assembly& assembly, const std::string& page_template);

}  // namespace dismantle
