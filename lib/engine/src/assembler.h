/// Algorithm 3: assembly by disassembly. From a layout of the parts, with ways from there to where the disassembly
/// left them, to the assembled state.
#pragma once

#include <string>
#include <vector>

#include "deferred_simulator.h"
#include "dismantle/engine/run.h"
#include "path_normalizer.h"
#include "plan_builder.h"

namespace dismantle {

struct AssemblyPlan {
  std::vector<PlanStep> steps;
  AssemblyStatus status = AssemblyStatus::complete;
  std::string message;
};

/// Each step of the disassembly makes a group, and each group has a place in the layout: a displacement from where the
/// disassembly left it. A group that is taken apart by later steps is put together at its place, and then moves in as
/// a whole. What was shifted part-way is shifted back where it is. So at every time each part is at one known place,
/// and what moves is verified against all others.
///
/// A group for which there is no way is left out of the layout: its step begins where the disassembly left it.
class Assembler {
 public:
  /// All references must outlive the assembler.
  Assembler(const Assembly& assembly, const DeferredSimulator& simulator, const PlanningSetup& setup,
            const RunOptions& options, const Verifier& verifier);

  /// `written` are the same steps as the plan has them.
  AssemblyPlan put_together(const std::vector<RecordedStep>& steps, const std::vector<PlanStep>& written,
                            const RunContext& context);

 private:
  struct Scenery;
  struct Way;
  class Checker;
  void place_groups(Scenery& scenery, const RunContext& context) const;
  void clear_ways_in(Scenery& scenery, const RunContext& context) const;
  std::vector<Way> transfers(const Scenery& scenery, std::size_t first, std::size_t last, const RunContext& context);
  Way transfer(const Scenery& scenery, std::size_t step, TransferPlanner& planner, const RunContext& context) const;
  PlanStep to_step(const Scenery& scenery, std::size_t step, const Way& way, const PlanStep& there) const;
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
