// Pairs that hold each other without overlap: proved, they are moved as one.
#include <algorithm>

#include "blocking/taking_apart.h"
#include "dismantle/verify/explanations.h"

namespace dismantle::blocking {
namespace {

constexpr std::size_t kProofs = 120;      // pairs of a run that are looked at closely, up to a second or two each
constexpr std::size_t kConfinements = 8;  // likewise, up to half a minute each

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
          join_pair(group, a, b, describe(*cage, assembly_));
          return true;
        }
    }
  return false;
}

/// After all searches: the only one that is known to be in a part's way, does it hold it? That proof is for motions
/// that cut in less than ways may, so it comes last.
bool TakingApart::join_confined(Group& group) {
  for (const UnitId u : group.units) {
    const std::optional<UnitId> v = alone_in_the_way(group, u);
    if (!v) continue;
    for (const PartId a : units_[u])
      for (const PartId b : units_[*v]) {
        if (stop() || confinements_ == kConfinements) return false;
        if (!confined_.insert(std::minmax(a, b)).second || passes_straight(a, b)) continue;
        ++confinements_;
        context_.progress("sequence", out_, units_.size() - 1, assembly_.parts[a].name);
        const auto confinement = confined(a, b);
        if (!confinement) continue;
        join_pair(group, a, b, describe(*confinement, assembly_));
        return true;
      }
  }
  return false;
}

/// The unit that all parts belong to which the last search for a way of `unit` touched; of two, the other.
auto TakingApart::alone_in_the_way(const Group& group, UnitId unit) const -> std::optional<UnitId> {
  if (group.units.size() == 2) return group.units[group.units[0] == unit ? 1 : 0];
  std::optional<UnitId> found;
  for (const PartId id : units_[unit]) {
    const auto said = said_.find(id);
    if (said == said_.end()) continue;
    for (const PartId by : said->second.blocked_by) {
      const UnitId v = unit_of_[by];
      if (v == unit || !in_group(group, v)) continue;
      if (found && *found != v) return std::nullopt;
      found = v;
    }
  }
  return found;
}

void TakingApart::join_pair(Group& group, PartId a, PartId b, const std::string& why) {
  context_.log(LogLevel::info, why);
  for (const auto& [part, other] : {std::pair(a, b), std::pair(b, a)}) {
    locked_[part] = true;
    held_.try_emplace(part, Unsolved{part, Outcome::exhausted, {other}, {}, why});
  }
  join(group, unit_of_[a], unit_of_[b]);
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
  group.groups_done = group.slides_done = group.turns_done = group.searched_out = group.pair_done =
      group.searches_done = false;
  ++counts_["held"];
}

}  // namespace dismantle::blocking
