// Groups that can move together along a direction.
#include <algorithm>
#include <utility>

#include "blocking_graph/graph.h"
#include "blocking_graph/straight_motion.h"

namespace dismantle::blocking {

/// Index of a member that blocks another one and is not `inside`: one that is known to, else the nearest.
std::optional<std::size_t> StraightMotion::blocker_outside(const GroupState& group, std::size_t member,
                                                           std::size_t direction,
                                                           const std::function<bool(std::size_t)>& inside) {
  struct Question {
    double gap;
    std::size_t other;
    Pair pair;
  };
  std::vector<Question> questions;
  for (std::size_t other = 0; other < group.members.size(); ++other) {
    if (other == member || inside(other)) continue;
    for (const Pair& pair : pairs_of(group.members[member], group.members[other], direction)) {
      if (relations_.known_to_block(pair)) return other;
      if (!relations_.known(pair)) questions.push_back({gap_of(pair), other, pair});
    }
  }
  std::stable_sort(questions.begin(), questions.end(), [](const auto& a, const auto& b) { return a.gap < b.gap; });
  if (relations_.wants_hints()) {
    std::vector<Pair> pairs;
    for (const Question& q : questions) pairs.push_back(q.pair);
    relations_.hint({pairs});
  }
  for (const Question& q : questions) {
    if (state_.stop()) return std::nullopt;
    if (relations_.blocks(q.pair)) return q.other;
  }
  return std::nullopt;
}

std::optional<SubassemblyId> StraightMotion::blocker_of(const GroupState& group, const Subassemblies& ids,
                                                        std::size_t direction) {
  std::vector<bool> moves(group.members.size());
  for (std::size_t k = 0; k < moves.size(); ++k)
    moves[k] = std::find(ids.begin(), ids.end(), group.members[k]) != ids.end();
  for (std::size_t k = 0; k < moves.size() && !state_.stop(); ++k)
    if (moves[k])
      if (const auto found = blocker_outside(group, k, direction, [&](std::size_t other) { return moves[other]; }))
        return group.members[*found];
  return std::nullopt;
}

std::vector<Subassemblies> StraightMotion::free_groups(const GroupState& group, std::size_t direction) {
  const auto found = blocking::free_groups(group.members.size(), [&](std::size_t member, const auto& inside) {
    return blocker_outside(group, member, direction, inside);
  });
  if (state_.stop()) return {};
  std::vector<Subassemblies> groups;
  for (const auto& indices : found) {
    groups.emplace_back();
    for (const std::size_t i : indices) groups.back().push_back(group.members[i]);
  }
  return groups;
}

}  // namespace dismantle::blocking
