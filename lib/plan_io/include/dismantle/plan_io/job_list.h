/// The fasteners and the tools of a whole job, for people and for purchase.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// Equal screws, nuts, washers, ..., and what drives them.
struct JobFastener {
  std::string kind, size;          ///< "screw", "M3x10"; no size: not known
  std::string drive{};             ///< "hex socket 2.5"; empty: not known, or no tool was looked for
  std::vector<std::string> tools;  ///< names, in the order of the assembly; several where not all have the same room
  std::optional<double> torque{};  ///< N m, as stated by the user
  std::string glue{};              ///< as stated by the user
  std::vector<std::string> parts;
  std::vector<std::size_t> steps;  ///< of the assembly, that put them in
};

/// A tool, and what it is for.
struct JobTool {
  std::string id, name;
  std::vector<std::size_t> steps;        ///< of the assembly
  std::vector<std::string> fasteners{};  ///< "4x M3x10"
};

/// All of them.
struct JobList {
  std::vector<JobFastener> fasteners;  ///< screws first
  std::vector<JobTool> tools;          ///< in the order of the assembly; empty: the plan does not say
};

/// Tools are those of the notes of `tool_access`. Fasteners of a product that stays in one piece are not listed, if it
/// is more than a fastener itself. `disassembly`: with the numbers of its steps instead of those of the assembly.
DISMANTLE_API JobList job_list(const Plan& plan, bool disassembly = false);

/// "4x screw M3x10: hex key 2.5; 0.6 N m; glue: blue".
DISMANTLE_API std::string fastener_words(const JobFastener& fastener);
/// "hex key 2.5: 4x M3x10, steps 3 and 5".
DISMANTLE_API std::string tool_words(const JobTool& tool);

/// RFC 4180: count, kind, size, drive, tools, torque (N m), glue, steps, parts; lists have semicolons between.
DISMANTLE_API std::string fasteners_csv(const Plan& plan);
/// RFC 4180: id, name, fasteners, steps; lists have semicolons between.
DISMANTLE_API std::string tools_csv(const Plan& plan);

}  // namespace dismantle
