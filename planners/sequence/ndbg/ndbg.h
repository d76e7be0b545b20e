/// Non-directional blocking graphs (Wilson and Latombe 1994): the parts and groups that some translation to infinity
/// removes.
#pragma once

#include "blocking_graph/directions.h"
#include "dismantle/parameters.h"
#include "dismantle/sequence_planner.h"
#include "one_by_one/one_by_one.h"

namespace dismantle {

/// Which cells of the arrangement of directions are examined; each value includes those before it.
enum class NdbgCells { vertices, arcs, faces };

struct NdbgParameters {
  PartOrder order = PartOrder::small_first;
  unsigned circles = 6;
  NdbgCells cells = NdbgCells::faces;
  bool groups = true;
  /// Largest number of subassemblies proposed to the verifier before a group of parts is given up.
  unsigned group_proposals = 8;
  bool searches = false;
  unsigned max_depth = 0;
  static void describe(Schema<NdbgParameters>& schema);
};

class Ndbg final : public SequencePlanner {
 public:
  explicit Ndbg(const NdbgParameters& params) : params_(params) {}
  SequencePlannerTraits traits() const noexcept override {
    return {.keeps_constraints = true, .any_start = true, .follows_objective = true};
  }
  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override;

 private:
  NdbgParameters params_;
};

namespace ndbg {

/// The axes of the parts, then one direction of each cell of the arrangement. The axis of a round surface is the point
/// in which the circles of all its normals cross.
blocking::Directions directions_of(const Assembly& assembly, unsigned circles, NdbgCells cells);

}  // namespace ndbg
}  // namespace dismantle
