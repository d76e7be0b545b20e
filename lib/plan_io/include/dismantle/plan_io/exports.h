/// A plan for other programs: poses as tables, the order of steps and the sub-assemblies as graphs, the steps as
/// Markdown. All texts are UTF-8, end with a line break, and are the same bytes for the same plan.
#pragma once

#include <string>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"
#include "dismantle/plan_io/travel.h"

namespace dismantle {

/// RFC 4180 with line feeds: a header, then one row per pose: animation ("disassembly", "assembly"), step, part, pose
/// (from 0), time (s, of the animation in plan.glb), x, y, z, qw, qx, qy, qz (input units; as in plan.json).
/// @throws InputError when the plan moves a part that the assembly does not have.
DISMANTLE_API std::string poses_csv(const Plan& plan, const Assembly& assembly);
/// The same as JSON, format "dismantle.poses" (docs/exports.md).
/// @throws InputError as poses_csv().
DISMANTLE_API std::string poses_json(const Plan& plan, const Assembly& assembly, const InputFrame& frame);

/// One node per disassembly step, an edge from each step to those that wait for it (`after` of the plan).
/// @throws InputError when the plan does not say what waits for what (one written before plans had `layer`).
DISMANTLE_API std::string step_order_dot(const Plan& plan);
/// GraphML 1.0 (graphml.graphdrawing.org). @throws InputError as step_order_dot().
DISMANTLE_API std::string step_order_graphml(const Plan& plan);

/// The AND/OR graph (Homem de Mello and Sanderson, IEEE Trans. Robotics and Automation 6(2), 1990) as far as the plan
/// has verified it: nodes are the sets of parts that exist as one piece at some time, a hyperarc is a step that takes
/// one of them apart. A plan is one solution, so a set has one hyperarc at most. Format "dismantle.and_or".
DISMANTLE_API std::string and_or_json(const Plan& plan);
/// The AND/OR graph of the plan's separations, for Graphviz.
DISMANTLE_API std::string and_or_dot(const Plan& plan);

/// Tables of GitHub's Markdown: the steps with direction, distance and what they wait for; what stays and what is
/// unsolved. Distances are the guided ones where they are known, else those of the verified paths, and the text says so.
DISMANTLE_API std::string steps_markdown(const Plan& plan, const InputFrame& frame, const GuidedDistances& guided = {});

/// Bill of materials, RFC 4180: a row for each kept component's product and each shape: item (from 1), count, name (of
/// the product, or of the first part), kind, size, length_x, length_y, length_z (of the box as assembled), unit, parts
/// (names with semicolons between). @throws InputError when the plan does not belong to the assembly.
DISMANTLE_API std::string bom_csv(const Plan& plan, const Assembly& assembly, const InputFrame& frame);
/// The steps of the assembly, RFC 4180: step, parts (names with semicolons between), motion (in words), x, y, z (unit
/// vector of the last stretch of the insertion), travel (the guided distance if it is known, else the length of the first
/// part's path), turn_degrees, unit, waits_for (steps
/// with semicolons between; "unknown" if the plan does not say), forced_depth (empty: not forced), notes.
DISMANTLE_API std::string steps_csv(const Plan& plan, const InputFrame& frame, const GuidedDistances& guided = {});

}  // namespace dismantle
