#include "dismantle/plan_io/groups.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

using PartSet = std::vector<std::size_t>;

/// Index in `pieces` of the piece that stays if the step names all parts of a group.
std::size_t staying_piece(const std::vector<PartSet>& pieces, const std::set<std::size_t>& movers) {
  const auto key = [&](const PartSet& piece) {
    const bool fixed = std::ranges::none_of(piece, [&](std::size_t i) { return movers.contains(i); });
    return std::pair(fixed, piece.size());
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < pieces.size(); ++i)
    if (key(pieces[i]) > key(pieces[best])) best = i;
  return best;
}

}  // namespace

std::vector<std::vector<GroupSplit>> follow_groups(const Plan& plan) {
  std::map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < plan.assembly.parts.size(); ++i) index_of.emplace(plan.assembly.parts[i].name, i);
  const auto index = [&](const std::string& name) {
    const auto it = index_of.find(name);
    if (it == index_of.end()) throw InputError(name, "the plan moves a part that the assembly does not have");
    return it->second;
  };

  std::vector<std::size_t> group_of(plan.assembly.parts.size(), 0);
  std::size_t groups = 1;
  std::vector<std::vector<GroupSplit>> out;
  for (const PlanStep& step : plan.disassembly) {
    std::set<std::size_t> movers;
    for (const PlanMove& move : step.moves) movers.insert(index(move.part));
    std::map<std::size_t, std::vector<PartSet>> pieces_of;  // by the group that they are taken from
    for (const auto& names : step.separates) {
      std::map<std::size_t, PartSet> by_group;
      for (const std::string& name : names) by_group[group_of[index(name)]].push_back(index(name));
      for (auto& [group, piece] : by_group) {
        std::ranges::sort(piece);
        pieces_of[group].push_back(std::move(piece));
      }
    }
    auto& splits = out.emplace_back();
    for (auto& [group, pieces] : pieces_of) {
      GroupSplit split;
      for (std::size_t i = 0; i < group_of.size(); ++i)
        if (group_of[i] == group) split.whole.push_back(i);
      std::set<std::size_t> taken;
      for (const PartSet& piece : pieces) taken.insert(piece.begin(), piece.end());
      for (const std::size_t i : split.whole)
        if (!taken.contains(i)) split.rest.push_back(i);
      if (split.rest.empty()) {
        const std::size_t stays = staying_piece(pieces, movers);
        split.rest = pieces[stays];
        pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(stays));
      }
      if (pieces.empty()) continue;
      for (const PartSet& piece : pieces) {
        for (const std::size_t i : piece) group_of[i] = groups;
        ++groups;
      }
      split.out = std::move(pieces);
      splits.push_back(std::move(split));
    }
  }
  return out;
}

}  // namespace dismantle
