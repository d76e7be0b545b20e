/// What rows are made with.
#pragma once

#include <string>

namespace dismantle::bench {

/// "0.1.0 (4733f43556)": the version, and the commit that this library was built from, if that is known. "-dirty" after
/// it: with changes that were not committed.
std::string version_and_commit();

}  // namespace dismantle::bench
