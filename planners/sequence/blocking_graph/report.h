/// The report at the end of a run: which parts are left, and why.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "blocking_graph/state.h"

namespace dismantle::blocking {

class Report {
 public:
  /// Both must outlive this.
  Report(DisassemblyState& state, PathOracle& oracle) : state_(state), oracle_(oracle) {}
  /// Reports the parts of a group that was given up. `notes` of the strategies are added to the message of each part.
  void add_left(const GroupState& group, const std::string& notes);
  /// Reports every part that is proved inseparable from another, with the proof.
  void add_inseparable();
  SequenceResult finish() const;

 private:
  Unsolved reason_for(const GroupState& group, PartId part, bool tried) const;
  Unsolved proof_for(SubassemblyId id, PartId part) const;
  Outcome outcome() const;

  DisassemblyState& state_;
  PathOracle& oracle_;
  std::vector<Unsolved> unsolved_;
  std::vector<PartId> remaining_;
};

}  // namespace dismantle::blocking
