/// From raw parts to an assembly (docs/preparation.md, appendix B.1).
#pragma once

#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/flexible.h"
#include "dismantle/importer.h"
#include "dismantle/parameters.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// Which parts may count as flexible.
enum class FlexibleParts {
  recognised,  ///< those that the user or the file declares, and those recognised by shape and contact
  declared,    ///< those that the user or the file declares
};

/// What becomes of parts whose surface is not closed after repair.
enum class OpenSurfaces {
  wall,     ///< they are planned: no part may pass through their surface
  exclude,  ///< they are left out
};

/// The `assembly:` section of a configuration. Each step of appendix B.1 is a parameter.
struct PrepareOptions {
  double weld = 1e-6;           ///< relative to the part's box diagonal
  bool repair = true;           ///< orient, close T-junctions and small holes, drop inner walls
  OpenSurfaces open = OpenSurfaces::wall;
  double max_hole = 0.1;        ///< largest hole that is closed, share of the part's surface area
  bool drop_duplicates = true;  ///< step 3
  double max_overlap = 1.0;     ///< step 4: drop parts with more than this share of their volume in others; 1 = never
  double min_thickness = 0.0;   ///< step 5: drop parts thinner than this share of the assembly; 0 = never
  bool largest_connected = false;  ///< step 6
  bool normalize = true;           ///< step 7
  double size = 10.0;              ///< step 7: largest edge of the bounding box, assembly units
  double subdivide = 0.5;          ///< step 9: longest edge, assembly units; 0 = off
  std::string unit;  ///< of an input that names none; empty: not known. Names as in unit_named()
  FlexibleParts flexible = FlexibleParts::recognised;
  std::int64_t max_triangles = 5'000'000;  ///< refuse larger assemblies with a clear message
  DISMANTLE_API static void describe(Schema<PrepareOptions>& s);
};

/// What was done to one part, in order.
struct PartReport {
  std::string name;
  std::string file;
  bool kept = true;
  bool by_choice = false;            ///< excluded by a rule of the configuration; it was usable
  bool by_meaning = false;           ///< excluded because its file says that it is no part (RawPart::by_meaning)
  std::vector<std::string> actions;  ///< plain sentences with figures: "welded 3024 vertices to 506"
  std::vector<std::string> summary;  ///< the same in short: "closed 24 holes, the largest 46 mm2 at (1, 2, 3)"
  std::string reason;                ///< not kept: why
  std::size_t vertices = 0, triangles = 0, shells = 0;
  bool watertight = false;
  std::string open{};  ///< kept although its surface is not closed: where it is open; else empty
  double volume = 0;   ///< input units cubed; an estimate if it is open
};

/// What preparation did with the input.
struct PrepareReport {
  std::vector<PartReport> parts;       ///< all that came in, in order
  std::vector<std::string> warnings;   ///< all, also those that `parts` and the assembly's overlaps tell
  std::vector<std::string> whole;      ///< those of `warnings` about the assembly as a whole
  std::vector<std::string> notes;      ///< about the input: nothing is wrong
  std::vector<FlexiblePart> flexible;  ///< parts that the file declares or that are recognised
};

/// Deterministic on any number of threads. `source` and `sha256` are copied into the assembly (see read_input.h).
/// Parts that are left out by the meaning of their format or by a rule count as excluded by choice.
/// @throws InputError when fewer than two usable parts are left, naming what was wrong with each.
/// @throws Error when `context` wants to stop; then see context.cancel and context.deadline.
DISMANTLE_API Assembly prepare_assembly(std::vector<RawPart> raw, const std::string& source, const std::string& sha256,
                                        const PrepareOptions& options, RunContext& context, PrepareReport& report);

}  // namespace dismantle
