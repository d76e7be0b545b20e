/// Algorithm 3: assembly by disassembly. Takes the parts from a layout to their disassembled poses by transfers, and
/// from there to the assembled state by the reversed disassembly.
#pragma once

#include <string>
#include <vector>

#include "deferred_simulator.h"
#include "dismantle/engine/run.h"
#include "path_normalizer.h"
#include "to_plan.h"

namespace dismantle {

struct AssemblyPlan {
  std::vector<PlanStep> steps;
  AssemblyStatus status = AssemblyStatus::complete;
  std::string message;
};

/// Each step of the disassembly makes a group, and each group has a place in the layout: a displacement from its
/// disassembled pose. A group that later steps take apart is assembled at its place, and then moves in as a whole.
/// Intermediate placements are undone in place. So each part has one known pose at any time, and each motion is
/// verified against all other parts.
///
/// A group without a transfer is left out of the layout: its step begins where the disassembly ended.
class Assembler {
 public:
  /// All references must outlive the assembler.
  Assembler(const Assembly& assembly, const DeferredSimulator& simulator, const PlanningSetup& setup,
            const RunOptions& options, const Verifier& verifier);

  /// `written`: its steps in the form of the plan.
  AssemblyPlan put_together(const Disassembly& done, const std::vector<PlanStep>& written, const RunContext& context);

 private:
  struct Scenery;
  class PartPlaces;
  struct Found;
  class Checker;
  void place_groups(Scenery& scenery, const RunContext& context) const;
  void clear_insertions(Scenery& scenery, const RunContext& context) const;
  std::vector<Found> transfers(const Scenery& scenery, std::vector<PartPlaces>& places, std::size_t first,
                               std::size_t last, const RunContext& context);
  Found transfer(const Scenery& scenery, std::size_t step, PartPlaces& places, TransferPlanner& planner,
                 const RunContext& context) const;
  PlanStep to_step(const Scenery& scenery, std::size_t step, const Found& found, const PlanStep& there) const;
  Aabb box_of(PartId part, const Pose& pose) const;

  const Assembly& assembly_;
  const DeferredSimulator& simulator_;
  const PreparedAssembly nothing_;  // the simulator prepares by itself
  const PlanningSetup& setup_;
  const RunOptions& options_;
  const Verifier& verifier_;
  PathNormalizer normalizer_;
  std::vector<std::shared_ptr<TransferPlanner>> planners_;  ///< by thread
};

}  // namespace dismantle
