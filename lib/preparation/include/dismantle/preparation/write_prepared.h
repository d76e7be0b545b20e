/// The files that `dismantle prepare` writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/assembly.h"
#include "dismantle/preparation/prepare.h"

namespace dismantle {

/// Writes the original triangles of each part of `assembly` as DIR/NAME.obj in input units (17 significant digits)
/// and DIR/prepare.json (format "dismantle.prepare", version 1: scale, parts with what was done to each and why,
/// overlaps in assembly and input units, excluded parts, warnings). Makes `dir` when it is missing; a part's name is
/// made safe as a file name. Returns the paths written, prepare.json last. @throws Error when a file cannot be
/// written.
DISMANTLE_API std::vector<std::filesystem::path> write_prepared(const Assembly& assembly, const PrepareReport& report,
                                                                const std::filesystem::path& dir);

}  // namespace dismantle
