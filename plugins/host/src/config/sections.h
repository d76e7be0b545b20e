/// Sections with fixed parameters whose values are not one struct of a library.
#pragma once

#include "dismantle/host/config.h"

namespace dismantle {

/// Takes the values of `config.sections["verify"]`, which is complete, into `verify` and `named_overlap`.
void bind_verify_section(RunConfig& config);

}  // namespace dismantle
