/// What the screws of an assembly do, and what is wrong with them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dismantle/preparation/check_assembly.h"

namespace dismantle {

class TriangleBvh;

/// Adds fastenings and findings, if kinds were looked at. @throws Error when `context` wants to stop.
void add_fastenings(const Assembly& assembly, const std::function<const TriangleBvh&(PartId)>& surface,
                    AssemblyCheck& check, const RunContext& context);

/// Lines for a terminal; empty: there are none.
std::string fastenings_text(const std::vector<CheckedFastening>& fastenings);

}  // namespace dismantle
