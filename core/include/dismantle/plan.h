/// The plan that is written, read, verified and shown. Its fields are those of the JSON in docs/plan-format.md.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/flexible.h"
#include "dismantle/outcome.h"
#include "dismantle/param_value.h"
#include "dismantle/part_kind.h"
#include "dismantle/pose.h"
#include "dismantle/step_note.h"

namespace dismantle {

/// Poses in a plan act on input coordinates, in input units.
struct PlanMove {
  std::string part;
  std::vector<Pose> poses;  ///< >= 2; all moves of a step have the same number
};

/// The deepest cut of a forced step: the pair with the largest penetration above its assembled overlap.
struct PlanForced {
  std::string part, other;                       ///< `part` moves
  double depth = 0;                              ///< deepest along the whole path, input units
  double assembled = 0;                          ///< overlap of the pair when assembled, input units
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< where, input units, world
  std::string reason;                            ///< why no verified path is known
  std::optional<std::size_t> certificate{};      ///< index into Plan::certificates: proof that there is none
  bool lower_bound = false;                      ///< time ran out while measuring: the true depth is at least `depth`
  std::string accepted{};                        ///< the user accepts it as this ("snap", "press"); empty: not accepted
};

/// A pair of parts that a step moves relative to each other and whose assembled overlap is large enough to report.
struct PlanStepOverlap {
  std::string part, other;              ///< `part` moves
  double assembled = 0;                 ///< depth when assembled, input units
  double allowed = 0;                   ///< depth that rule (b) allows, without the tolerance; input units
  double depth = 0;                     ///< the deepest along the step, input units, measured
  std::optional<Eigen::Vector3d> at{};  ///< point of that depth; input units, world
  /// The only region where they may be so deep, in the frame of either part; input units, assembled.
  std::optional<Aabb> region{};
};

/// A Certificate with names instead of ids. Poses act on input coordinates, in input units; numbers as in Certificate.
struct PlanCertificate {
  std::string kind;
  std::vector<std::string> parts;
  std::vector<Pose> poses;  ///< in the order of `parts`; empty: as assembled
  bool full_tolerance = false;
  double margin = 0;  ///< assembly units
  std::map<std::string, std::vector<double>> numbers;
  std::string text;
};

/// What a step check says about a step, or about the plan as a whole.
struct PlanVerdict {
  std::string type;  ///< of the check
  double weight = 1;
  double cost = 0;  ///< without the weight
  bool allowed = true;
  std::string reason{};
  std::string failed{};  ///< not empty: the check could not judge, and why; the rest then says nothing
  std::vector<StepNote> notes{};
  std::optional<PlanCertificate> certificate{};
};

/// A check of the objective.
struct PlanObjectiveItem {
  std::string type;
  double weight = 1;
  bool require = false;
  ParamSet parameters{};
  double cost = 0;                    ///< of all steps and of the plan as a whole, without the weight
  std::optional<PlanVerdict> plan{};  ///< of the plan as a whole; none: the check judges steps only
};

/// What another order costs that was judged and not taken: the one that was found first (`step` 0), or that of the plan
/// with disassembly step `step` at the place of step `place`.
struct PlanAlternative {
  unsigned step = 0, place = 0;
  std::vector<PlanVerdict> checks;  ///< as PlanObjective::checks; cost: over all steps; reason: why it is more
};

/// What the steps of a plan were judged by, and the sum.
struct PlanObjective {
  std::vector<PlanObjectiveItem> checks;          ///< empty: the plan was not judged
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< how the assembly lies; unit
  double cost = 0;                                ///< weighted sum over all steps and checks
  /// No order of what was asked for costs less: a proved bound. None: not known. Equal to `cost`: the order is optimal.
  std::optional<double> least_cost{};
  std::vector<PlanAlternative> alternatives{};
  bool empty() const { return checks.empty(); }
};

/// One step: the parts that move and the parts that this separates.
struct PlanStep {
  unsigned step = 0;  ///< from 1
  std::vector<PlanMove> moves;
  std::vector<std::vector<std::string>> separates;
  double max_penetration = 0;  ///< assembly units, certified bound above the initial overlap
  double seconds = 0;
  std::string planner;
  unsigned depth = 0;
  std::vector<std::string> contacts;  ///< parts touched along the path
  /// Assembly steps: index of the pose at which the transfer from the layout ends and the reversed disassembly path
  /// begins. 0 = no transfer; the step begins where the disassembly ended.
  std::size_t transfer = 0;
  /// Disassembly steps: numbers of the steps that must precede this one, without those implied by others.
  std::vector<unsigned> after;
  /// Disassembly steps: 1 + the largest layer of `after`, or 1. Steps of one layer need not wait for each other.
  unsigned layer = 0;
  /// Set if no verified motion was found and the parts are removed where they cut in least. Such a step is not valid by
  /// rule (b), and `max_penetration` has no meaning.
  std::optional<PlanForced> forced{};
  std::vector<PlanStepOverlap> overlaps{};  ///< disassembly steps
  std::optional<Eigen::Vector3d> up{};      ///< unit; how the assembly lies during the step; none: as PlanObjective::up
  /// Disassembly steps: what the objective says of the step as an assembly operation, which is the step backwards.
  std::vector<PlanVerdict> checks{};
};

/// Where a part touches another.
struct PlanPlace {
  std::string part;                              ///< the other
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< input units, world
};

/// A part that is left, and why.
struct PlanUnsolved {
  std::string part;
  Outcome outcome = Outcome::exhausted;
  std::vector<std::string> blocked_by;
  Pose best_pose;
  std::string message;
  std::optional<std::size_t> certificate{};  ///< index into Plan::certificates
  std::string planner{};                     ///< id of the path planner that searched; empty: no search was made
  unsigned attempts = 0;                     ///< searches for removing the part, alone or with others
  double seconds = 0;                        ///< of these, together
  unsigned depth = 0;                        ///< the largest depth that was allowed; 0: none of them had a limit
  std::string refused_by{};         ///< id of the required step check that did not allow a removal; empty: none did
  std::vector<PlanPlace> places{};  ///< what the part touches at `best_pose`: the deepest contact with each other part
};

/// A part of the assembly, as the plan file names it.
struct PlanPart {
  unsigned id = 0;
  std::string name;
  std::string file;
  std::optional<Rgba> colour{};        ///< opaque
  std::vector<std::string> parents{};  ///< assemblies in its file that contain it, outermost first
  std::optional<Flexible> flexible{};  ///< none: rigid
  std::string product{};               ///< name of the product in its file whose body it is; empty: not known
  bool open = false;                   ///< the surface is not closed: a wall
  std::optional<PartKind> kind{};      ///< none: not looked at
};

/// A product of the file with several bodies, and how it was read.
struct PlanComponent {
  std::string name;                ///< unique in the plan
  std::string product;             ///< equal for all uses of one product
  std::vector<std::string> parts;  ///< its bodies
  bool kept = true;                ///< as one unit; false: its parts are planned one by one
  std::string reason;              ///< of this reading
};

/// A ReferenceStep with the names of the parts.
struct PlanReferenceStep {
  unsigned step = 0;
  std::vector<std::string> parts;
  std::string group;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

/// Two parts that overlap when assembled.
struct PlanOverlap {
  std::string a, b;
  double depth = 0;                     ///< assembly units
  std::optional<OverlapPlace> place{};  ///< input units; none: the file does not say
  std::optional<double> declared{};     ///< depth allowed for this pair, whatever its overlap; assembly units
  bool flexible = false;                ///< `declared` is not by the user: one of the two bends, by its file or shape
};

/// A part of the input that is not in the plan.
struct PlanExcluded {
  std::string name, reason;
  bool unusable = false;  ///< the user wanted it; false: left out by a rule of the configuration, or not known
  bool operator==(const PlanExcluded&) const = default;
};

/// The assembly that a plan is for, as the plan file states it.
struct PlanAssembly {
  std::string source, sha256;
  double scale = 1;                                  ///< assembly units per input unit
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< input units; internal = scale * (x - center)
  Aabb box;                                          ///< input units
  SurfaceRepair repair;
  ImportParameters import_params;
  std::string unit;  ///< input unit; empty when the files do not say
  std::vector<PlanPart> parts;
  std::vector<PlanExcluded> excluded;
  std::vector<PlanOverlap> overlaps;
  std::vector<PlanComponent> components{};
  std::vector<PlanReferenceStep> reference_order{};  ///< how the file's author builds it; empty: the file does not say
};

/// What a plan was asked for; by default the whole assembly, each part by itself.
struct PlanAsked {
  std::string part{};                                ///< only the path of this part, all others fixed; empty: no
  std::string target{};                              ///< take this part out, no more than that; empty: no
  std::vector<std::vector<std::string>> together{};  ///< parts that stay together
  bool operator==(const PlanAsked&) const = default;
};

/// The meaning of success: is what was asked for done, when these groups of parts are left? Every group is one part or
/// stays together, or the part that was asked for is out.
DISMANTLE_API bool is_done(const PlanAsked& asked, const std::vector<std::vector<std::string>>& groups);

/// How much of what was asked for a plan does.
enum class PlanStatus {
  complete,  ///< all of it, by verified steps only; see is_done()
  forced,    ///< all of it, some steps are forced
  partial,   ///< parts are still together that were to be separated
};

/// The largest tolerance of the plan format, for an assembly of size 10. A plan that was made with a larger one is
/// verified with this one.
inline constexpr double kLargestTolerance = 0.01;

/// What `assembly_steps` are.
enum class AssemblyStatus {
  complete,  ///< all steps of the disassembly, reversed, from the layout on
  partial,   ///< some parts have no path from the layout; `assembly_message` names them
  reversed,  ///< only the reversed disassembly: no layout was requested
};

/// How an assembly comes apart and is put together: what plan.json holds (docs/plan-format.md).
struct Plan {
  std::string generator_name = "dismantle";
  std::string generator_version;
  PlanAssembly assembly;
  PlanAsked asked;
  PlanStatus status = PlanStatus::partial;
  std::uint64_t seed = 0;
  double verified_max_penetration = kLargestTolerance;  ///< the tolerance that every step was verified with
  std::vector<PlanStep> disassembly;
  std::vector<PlanStep> assembly_steps;
  AssemblyStatus assembly_status = AssemblyStatus::reversed;
  std::string assembly_message;  ///< why partial; else empty
  std::vector<std::string> remaining;
  std::vector<PlanUnsolved> unsolved;
  std::vector<PlanCertificate> certificates;  ///< proofs that parts cannot be separated
  PlanObjective objective;

  /// The one condition for exit status 0: the plan is complete, and no part was left out that the user wanted (one that
  /// was not asked for may be left out).
  DISMANTLE_API bool succeeded() const;

  /// Disassembly steps that are forced.
  std::size_t forced_steps() const {
    return static_cast<std::size_t>(
        std::count_if(disassembly.begin(), disassembly.end(), [](const PlanStep& s) { return s.forced.has_value(); }));
  }
};

}  // namespace dismantle
