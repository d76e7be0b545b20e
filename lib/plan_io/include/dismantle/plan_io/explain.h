/// Why parts did not come out, and why the others came out in this order. All lengths are in the input's unit.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"

namespace dismantle {

/// Known values of the run's configuration by key ("run.path_timeout" -> "120"), as in resolved.yaml.
using ExplainSettings = std::map<std::string, std::string>;

/// What holds a part.
struct Blocker {
  std::string part;
  std::optional<Eigen::Vector3d> at;  ///< where the two touch when the held part is at its best pose; input units
  double overlap = 0;                 ///< of the two when assembled; input units
};

/// One part that did not come out.
struct LeftPart {
  std::string part;
  std::vector<Blocker> blockers;  ///< those touched most often first
  Pose best_pose;                 ///< input units
  bool moved = false;             ///< the best pose is not the last one in the plan
  double travel = 0;              ///< from there, of the assembly's centre as if it moved with the part; input units
  double turn = 0;                ///< from there, rad
  std::string planner;            ///< empty: no search was made
  unsigned attempts = 0, depth = 0;
  double seconds = 0;
  std::string message;  ///< what the planner said
};

/// Parts that did not come out for the same reason.
struct LeftReason {
  Outcome outcome = Outcome::exhausted;
  std::string meaning;  ///< the outcome in words
  std::vector<LeftPart> parts;
  const PlanCertificate* certificate = nullptr;  ///< of the plan; null: nothing is proved
  std::size_t certificate_number = 0;
  std::vector<std::string> advice;  ///< what the user can do, with the key to set
};

/// One step: what came out, and what had to come out before.
struct StepReason {
  unsigned step = 0;
  std::vector<std::string> parts;       ///< that it moves
  std::vector<unsigned> after;          ///< steps that had to come first, without those implied by others
  std::vector<std::string> waited_for;  ///< the parts that left in these steps
  std::vector<std::string> contacts;    ///< parts touched on the way
  bool known = false;                   ///< false: the plan does not say which steps had to come first
};

/// Refers to the plan that it explains.
struct Explanation {
  const Plan* plan = nullptr;
  std::vector<StepReason> steps;
  std::vector<LeftReason> left;      ///< most parts first
  std::vector<std::string> untried;  ///< parts that are still together and have no failed attempt on record
};

/// `part`: only this one; empty: all. @throws InputError when the plan has no such part.
DISMANTLE_API Explanation explain(const Plan& plan, const ExplainSettings& settings, const std::string& part = {});
/// For a terminal; ends with a line break.
DISMANTLE_API std::string explain_text(const Explanation& explanation, const TextUnit& unit);
DISMANTLE_API std::string explain_text(const Explanation& explanation);  ///< in length_unit()
/// One JSON object (docs/cli.md).
DISMANTLE_API std::string explain_json(const Explanation& explanation);

/// What a forced step does: "pin cuts 0.3 mm into hub (0.1 mm when assembled)".
DISMANTLE_API std::string forced_text(const TextUnit& unit, const PlanForced& forced);
DISMANTLE_API std::string forced_text(const Plan& plan, const PlanForced& forced);  ///< in length_unit()
/// How far the parts of a forced step of Plan::disassembly come before they cut in: "pin comes 12 mm up (+Z) without
/// cutting in"; empty: not known.
DISMANTLE_API std::string reached_text(const Plan& plan, const TextUnit& unit, const PlanStep& step);
/// The line of a configuration that accepts a forced step as it is; empty if it is accepted.
DISMANTLE_API std::string acceptance_line(const PlanForced& forced);
/// What the user can do beyond what its reason says, with that line; empty: nothing.
DISMANTLE_API std::string forced_advice(const PlanForced& forced);
/// A line for each overlap that the step makes use of; may be empty.
DISMANTLE_API std::string overlaps_text(const TextUnit& unit, const PlanStep& step);
DISMANTLE_API std::string overlaps_text(const Plan& plan, const PlanStep& step);  ///< in length_unit()
/// The unit in which people state lengths of the plan's input: text_unit(); "input units" where the files do not say.
DISMANTLE_API TextUnit length_unit(const Plan& plan);
/// A length in input units in this unit: "0.25 mm".
DISMANTLE_API std::string length_text(const TextUnit& unit, double length);
/// The same in length_unit().
DISMANTLE_API std::string length_text(const Plan& plan, double length);

}  // namespace dismantle
