#include "blocking_graph/pair_proofs.h"

#include <algorithm>
#include <utility>

namespace dismantle::blocking {

namespace {

/// The certificate of a failure, if it is about two parts of the group wherever the others are; else null.
const Certificate* proof_of(const DisassemblyState& state, const GroupState& group, const Unsolved& failure) {
  if (failure.outcome != Outcome::infeasible || failure.certificate == nullptr) return nullptr;
  const Certificate& c = *failure.certificate;
  const bool here =
      std::all_of(c.parts.begin(), c.parts.end(), [&](PartId p) { return group.contains(state.subassembly_of(p)); });
  return c.parts.size() == 2 && c.poses.empty() && here ? &c : nullptr;
}

}  // namespace

const Certificate* pair_proof(const DisassemblyState& state, const GroupState& group, PartId part) {
  const auto about_part = [&](const Unsolved& failure) -> const Certificate* {
    const Certificate* proof = proof_of(state, group, failure);
    return proof != nullptr && contains(proof->parts, part) ? proof : nullptr;
  };
  if (const Unsolved* own = state.failure_of(part))
    if (const Certificate* proof = about_part(*own)) return proof;
  for (const auto& [other, failure] : state.failures())
    if (const Certificate* proof = about_part(failure)) return proof;
  return nullptr;
}

/// Asked after each removal: it looks at the failures, which are few, and not at the members.
bool is_locked(const DisassemblyState& state, const GroupState& group) {
  std::vector<std::pair<SubassemblyId, SubassemblyId>> pairs;
  for (const auto& [part, failure] : state.failures())
    if (const Certificate* proof = proof_of(state, group, failure))
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
