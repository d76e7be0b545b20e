/// Groups that the file says are built by themselves: the sub-models of a reference order, and the whole.
#pragma once

#include <vector>

#include "blocking_graph/state.h"
#include "dismantle/assembly.h"

namespace dismantle::blocking {

class StatedGroups {
 public:
  explicit StatedGroups(const Assembly& assembly);
  /// The file does not say how it is built.
  bool empty() const { return groups_.empty(); }
  /// What leaves together: the largest stated groups inside of this one, as far as they are still in it, and the
  /// members that are in none.
  std::vector<Subassemblies> items(const DisassemblyState& state, const GroupState& group) const;

 private:
  std::vector<std::vector<PartId>> groups_;  // ascending parts; the largest groups first
};

}  // namespace dismantle::blocking
