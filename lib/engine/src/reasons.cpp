#include "reasons.h"

#include <algorithm>

#include "dismantle/part_set.h"

namespace dismantle {

std::vector<Unsolved> reasons_of(const SequenceResult& said, const std::vector<std::vector<PlacedPart>>& groups) {
  std::vector<PartId> left;
  for (const auto& group : groups)
    for (const PlacedPart& p : group) left.push_back(p.part);
  std::vector<Unsolved> result;
  for (const Unsolved& u : said.unsolved)
    if (contains(left, u.part)) result.push_back(u);
  for (const PartId id : left) {
    if (std::any_of(result.begin(), result.end(), [id](const Unsolved& u) { return u.part == id; })) continue;
    const bool planned = said.outcome != Outcome::cancelled && said.outcome != Outcome::timeout;
    result.push_back({id,
                      is_success(said.outcome) ? Outcome::crashed : said.outcome,
                      {},
                      {},
                      planned ? "the sequence planner gave no reason" : "not tried: the run was stopped before"});
  }
  for (Unsolved& u : result) {
    std::erase_if(u.blocked_by, [&](PartId id) { return !contains(left, id); });
    if (u.certificate != nullptr && !contains(u.certificate->parts, u.part)) u.certificate = nullptr;
    // A claim without a certificate cannot be checked.
    if (u.outcome == Outcome::infeasible && (u.certificate == nullptr || !u.certificate->full_tolerance))
      u.outcome = Outcome::exhausted;
  }
  return result;
}

void prove_left(std::vector<Unsolved>& unsolved, const std::vector<std::vector<PlacedPart>>& groups,
                ProofSchedule& proofs, const ProofOptions& options, const RunContext& context) {
  std::size_t asked = 0;
  for (Unsolved& u : unsolved) {
    const bool open =
        u.certificate == nullptr && !context.should_stop() && asked < options.final_parts &&
        (u.outcome == Outcome::depth_limit || u.outcome == Outcome::exhausted || u.outcome == Outcome::timeout);
    if (open) {
      ++asked;
      std::vector<PartId> group{u.part};
      for (const auto& placed : groups)
        if (contains(placed, u.part))
          for (const PlacedPart& p : placed)
            if (p.part != u.part) group.push_back(p.part);
      u.certificate = proofs.at_last(u.part, u.blocked_by, group, context);
    }
    if (u.certificate == nullptr) continue;
    if (u.certificate->full_tolerance) u.outcome = Outcome::infeasible;
    u.message = u.certificate->text;
    u.blocked_by = u.certificate->parts;
    std::erase(u.blocked_by, u.part);
  }
}

}  // namespace dismantle
