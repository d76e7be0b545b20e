// Pairs that hold each other without overlap: proved, they are moved as one.
#include <algorithm>

#include "blocking/taking_apart.h"
#include "dismantle/verify/explanations.h"

namespace dismantle::blocking {
namespace {

constexpr std::size_t kProofs = 120;  // pairs of a run that are looked at closely, up to a second or two each

}  // namespace

/// Does `a` pass `b` along any of their directions? Then no proof is to be had.
bool TakingApart::passes_straight(PartId a, PartId b) {
  std::vector<std::size_t> list = directions_.of_part[a];
  list.insert(list.end(), directions_.of_part[b].begin(), directions_.of_part[b].end());
  return std::any_of(list.begin(), list.end(), [&](std::size_t d) {
    return !relations_->blocks({a, b, d, poses_[a].t - poses_[b].t, turn_[a], turn_[b]});
  });
}

/// Looks for a pair of the group that is proved to hold each other, and makes one unit of the two. Each pair is looked
/// at once in a run.
bool TakingApart::join_held(Group& group) {
  for (std::size_t i = 0; i < group.units.size(); ++i)
    for (std::size_t k = i + 1; k < group.units.size(); ++k) {
      const UnitId u = group.units[i], v = group.units[k];
      for (const PartId a : units_[u])
        for (const PartId b : units_[v]) {
          if (stop() || proofs_ == kProofs) return false;
          if (!looked_at_.insert(std::minmax(a, b)).second || passes_straight(a, b)) continue;
          ++proofs_;
          context_.progress("sequence", out_, units_.size() - 1, assembly_.parts[a].name);
          const auto cage = oracle_.judge()->caged(a, b);
          if (!cage) continue;
          const std::string why = describe(*cage, assembly_);
          context_.log(LogLevel::info, why);
          for (const auto& [part, other] : {std::pair(a, b), std::pair(b, a)}) {
            locked_[part] = true;
            held_.try_emplace(part, Unsolved{part, Outcome::exhausted, {other}, {}, why});
          }
          join(group, u, v);
          return true;
        }
    }
  return false;
}

/// Makes one unit of two, under the number of the first.
void TakingApart::join(Group& group, UnitId u, UnitId v) {
  for (const PartId id : units_[v]) unit_of_[id] = u;
  units_[u].insert(units_[u].end(), units_[v].begin(), units_[v].end());
  std::sort(units_[u].begin(), units_[u].end());
  units_[v].clear();
  std::erase(group.units, v);
  // What was known of either says too little of both.
  watched_[u].clear();
  watched_[v].clear();
  refused_.clear();
  group.groups_done = group.slides_done = group.turns_done = group.searched_out = group.pair_done = false;
  ++counts_["held"];
}

}  // namespace dismantle::blocking
