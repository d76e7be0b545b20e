#include "blocking/strategies/simultaneous_motion.h"

#include <algorithm>

#include "blocking_graph/pair_proofs.h"

namespace dismantle::blocking {
namespace {

/// Rounds over the candidate sets: pairs, then all sets, then some of them to `simultaneous_depth`.
constexpr unsigned kRounds = 3;

/// How far the part has moved between two poses, including rotation, measured on the ball around its box.
double travel(const Mesh& mesh, const Pose& from, const Pose& to) {
  const Aabb box = mesh.box();
  return box.empty() ? (to.t - from.t).norm() : screw_travel(from, to, box.center(), 0.5 * box.size().norm());
}

}  // namespace

SimultaneousMotion::SimultaneousMotion(DisassemblyState& state, PathOracle& oracle, StraightMotion& straight,
                                       const Lookahead& lookahead, const SearchHistory& history, SnapFits& snaps,
                                       PairRelaxation& relaxation, const SimultaneousMotionParameters& params,
                                       unsigned max_depth, double play)
    : state_(state),
      oracle_(oracle),
      straight_(straight),
      lookahead_(lookahead),
      history_(history),
      snaps_(snaps),
      relaxation_(relaxation),
      params_(params),
      play_(play),
      max_depth_(max_depth) {}

/// Compares the cost so far with that of the searches for single parts. No set waits forever, as these end.
bool SimultaneousMotion::can_afford(const GroupState& group) const {
  return group.searches_exhausted || work_ <= params_.simultaneous_share * history_.work();
}

/// One round after the first round of path searches, the next after the second, and so on.
Result SimultaneousMotion::apply(GroupState& group) {
  if (group.members.size() < 3 || group.proof != nullptr) return Result::unchanged;
  const unsigned allowed = group.searches_exhausted || group.search_depth > 2 ? kRounds : group.search_depth - 1;
  Progress& progress = progress_[group];
  if (unsupported_ || progress.rounds >= allowed) return Result::unchanged;
  const std::vector<Subassemblies> sets = candidate_sets(group);
  while (progress.rounds < allowed) {
    const unsigned round = progress.rounds + 1;
    std::vector<Subassemblies> list;
    for (const Subassemblies& set : sets)
      if (!progress.tried.contains(set) && (round > 1 || set.size() == 2) &&
          (round < kRounds || list.size() + progress.tried.size() < params_.simultaneous_deep_sets) &&
          is_worthwhile(group, set, round) && !is_held_pair(group, set, round))
        list.push_back(set);
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (state_.stop() || unsupported_ || !can_afford(group)) return Result::unchanged;
      progress.tried.insert(list[k]);
      if (move(group, list, k, round)) return Result::restart;
    }
    progress.tried.clear();
    progress.rounds = round;
  }
  if (!sets.empty())
    progress.note = std::to_string(sets.size()) +
                    " sets of parts were moved simultaneously, each part in its own way, without success";
  return Result::unchanged;
}

/// Sets in which the other members are the only blockers of one member along some direction, from the blocking graphs.
/// Small sets come first, then sets to which this applies along most directions. The housing is never moved.
std::vector<Subassemblies> SimultaneousMotion::candidate_sets(const GroupState& group) {
  const SubassemblyId housing = state_.housing_of(group);
  const auto moves = [&](SubassemblyId s) {
    return s != housing && state_.is_single(s) && !state_.is_base(state_.part_of(s));
  };
  std::vector<Subassemblies> sets;
  std::map<Subassemblies, std::size_t> directions;
  for (const SubassemblyId s : group.members) {
    if (!moves(s) || !state_.may_leave(group, {s})) continue;
    for (const std::size_t d : straight_.directions().common) {
      Subassemblies set = straight_.blockers(group, s, d);
      if (state_.stop()) return {};
      if (set.empty() || set.size() + 1 > params_.simultaneous_parts || !std::all_of(set.begin(), set.end(), moves))
        continue;
      set.push_back(s);
      std::sort(set.begin(), set.end());
      if (++directions[set] == 1) sets.push_back(std::move(set));
    }
  }
  std::stable_sort(sets.begin(), sets.end(), [&](const auto& a, const auto& b) {
    return a.size() != b.size() ? a.size() < b.size() : directions[a] > directions[b];
  });
  if (sets.size() > params_.simultaneous_sets) sets.resize(params_.simultaneous_sets);
  return sets;
}

unsigned SimultaneousMotion::depth_of(unsigned round) const { return round < kRounds ? 1 : params_.simultaneous_depth; }

/// Nothing if none of `ids` may leave.
std::optional<Attempt> SimultaneousMotion::attempt_for(const GroupState& group, const Subassemblies& ids,
                                                       unsigned round) const {
  Attempt attempt = state_.attempt_for(group, ids);
  for (const SubassemblyId s : ids)
    if (state_.may_leave(group, {s})) attempt.goal.any_of.push_back(state_.part_of(s));
  if (attempt.goal.any_of.empty()) return std::nullopt;
  attempt.max_depth = std::min(depth_of(round), max_depth_);
  return attempt;
}

/// As for single parts, a search is repeated when a part that it touched has left; deeper only if several parts moved.
/// Parts that snap fits hold leave one by one, unless several of them have moved simultaneously: the interference of a
/// snap fit is measured along straight motions only. Those that are proved to be held do not leave.
bool SimultaneousMotion::is_worthwhile(const GroupState& group, const Subassemblies& ids, unsigned round) {
  const auto known = last_.find(ids);
  const bool several_moved = known != last_.end() && known->second.several_moved;
  if (std::all_of(ids.begin(), ids.end(), [&](SubassemblyId s) {
        return (!several_moved && snaps_.is_snap_fit(group, s)) || is_held(group, s);
      }))
    return false;
  if (known == last_.end()) return true;
  const PastMotion& last = known->second;
  if (std::any_of(last.blocked_by.begin(), last.blocked_by.end(),
                  [&](PartId part) { return !group.contains(state_.subassembly_of(part)); }))
    return true;
  return last.outcome == Outcome::depth_limit && last.depth < depth_of(round) && last.several_moved;
}

/// Two that do not even separate when all others are taken away: asked of those that snap, and of all before deep
/// searches. Takes a search, so it is asked last.
bool SimultaneousMotion::is_held_pair(const GroupState& group, const Subassemblies& ids, unsigned round) {
  if (ids.size() != 2) return false;
  return round == kRounds ? relaxation_.holds(state_.part_of(ids[0]), state_.part_of(ids[1]))
                          : snaps_.is_held_pair(group, ids[0], ids[1]);
}

/// Is it proved that another part of the group holds it?
bool SimultaneousMotion::is_held(const GroupState& group, SubassemblyId id) const {
  return pair_proof(state_, group, state_.part_of(id)) != nullptr;
}

/// Searches for a motion of the k-th set.
bool SimultaneousMotion::move(GroupState& group, const std::vector<Subassemblies>& sets, std::size_t k,
                              unsigned round) {
  const Subassemblies& ids = sets[k];
  const std::optional<Attempt> attempt = attempt_for(group, ids, round);
  if (!attempt) return false;
  RunContext& context = state_.context();
  state_.show_progress(attempt->moving.front().part);
  std::vector<Attempt> next;
  for (std::size_t n = k + 1; n < sets.size(); ++n)
    if (auto later = attempt_for(group, sets[n], round)) next.push_back(std::move(*later));
  lookahead_.before_attempts(*attempt, std::move(next));
  const AttemptResult& answer = oracle_.attempt(*attempt, context);
  const PathResult& result = answer.result;
  std::string names;
  for (const SubassemblyId s : ids)
    names += (names.empty() ? "'" : "', '") + state_.assembly().parts[state_.part_of(s)].name;
  context.log(LogLevel::debug, "simultaneous motion of " + names + "' to depth " + std::to_string(attempt->max_depth) +
                                   ": " + std::string(to_string(result.outcome())) + ", " +
                                   std::to_string(answer.seconds) + " s " + result.message);
  if (is_success(result.outcome())) {
    state_.commit(group, ids, *attempt, answer, GroupChange::Kind::one_removed);
    state_.count("simultaneous");
    return true;
  }
  unsupported_ = unsupported_ || result.outcome() == Outcome::unsupported;
  std::vector<PartId> moving;
  for (const PlacedPart& p : attempt->moving) moving.push_back(p.part);
  work_ += history_.work_of(moving, result);
  last_[ids] = {attempt->max_depth, result.outcome(), result.blocked_by, several_moved(*attempt, result.best_pose)};
  return false;
}

bool SimultaneousMotion::several_moved(const Attempt& attempt, const std::vector<Pose>& reached) const {
  std::size_t moved = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const PlacedPart& p = attempt.moving[i];
    if (travel(*state_.assembly().parts[p.part].mesh, p.pose, reached[i]) > play_) ++moved;
  }
  return moved > 1;
}

void SimultaneousMotion::on_group_changed(GroupState& group, const GroupChange& change) {
  progress_[group] = {};
  if (change.moves_remaining()) last_.clear();
}

std::string SimultaneousMotion::failure_note(const GroupState& group) const {
  const Progress* progress = progress_.find(group);
  return progress == nullptr ? std::string() : progress->note;
}

}  // namespace dismantle::blocking
