#include "blocking_graph/pair_proofs.h"

#include <algorithm>
#include <utility>

namespace dismantle::blocking {

namespace {

/// Found by the last search for the part.
const Certificate* own_proof(const DisassemblyState& state, const GroupState& group, PartId part) {
  const Unsolved* failure = state.failure_of(part);
  if (failure == nullptr || failure->outcome != Outcome::infeasible || failure->certificate == nullptr) return nullptr;
  const Certificate& c = *failure->certificate;
  const bool here =
      std::all_of(c.parts.begin(), c.parts.end(), [&](PartId p) { return group.contains(state.subassembly_of(p)); });
  return c.parts.size() == 2 && c.poses.empty() && here ? &c : nullptr;
}

}  // namespace

const Certificate* pair_proof(const DisassemblyState& state, const GroupState& group, PartId part) {
  if (const Certificate* own = own_proof(state, group, part); own != nullptr && contains(own->parts, part)) return own;
  for (const PartId other : state.parts_of(group.members))
    if (const Certificate* proof = own_proof(state, group, other); proof != nullptr && contains(proof->parts, part))
      return proof;
  return nullptr;
}

bool is_locked(const DisassemblyState& state, const GroupState& group) {
  std::vector<std::pair<SubassemblyId, SubassemblyId>> pairs;
  for (const PartId part : state.parts_of(group.members))
    if (const Certificate* proof = own_proof(state, group, part))
      pairs.emplace_back(state.subassembly_of(proof->parts.front()), state.subassembly_of(proof->parts.back()));
  if (pairs.size() + 1 < group.members.size()) return false;
  Subassemblies reached{group.members.front()};
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (const auto& [a, b] : pairs)
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
        if (from == reached[k] && std::find(reached.begin(), reached.end(), to) == reached.end()) reached.push_back(to);
  return reached.size() == group.members.size();
}

}  // namespace dismantle::blocking
