#include "blocking/taking_apart.h"

#include <algorithm>
#include <numeric>

namespace dismantle::blocking {

TakingApart::TakingApart(const BlockingParams& params, const Assembly& assembly, PathOracle& oracle,
                         SequenceObserver& observer, RunContext& context)
    : params_(params),
      assembly_(assembly),
      oracle_(oracle),
      observer_(observer),
      context_(context),
      unit_of_(assembly.parts.size(), kUnknown),
      poses_(assembly.parts.size()),
      turn_(assembly.parts.size(), 0),
      slides_(assembly) {
  const Constraints& wishes = oracle.constraints();
  // Lists that share a part are one unit.
  std::vector<PartId> root(assembly.parts.size());
  std::iota(root.begin(), root.end(), PartId{0});
  const auto find = [&](PartId id) {
    while (root[id] != id) id = root[id];
    return id;
  };
  for (const auto& list : wishes.together)
    for (const PartId id : list) root[find(id)] = find(list.front());
  // What nothing can part is moved as one, and others may leave it; that it is not parted is said at the end.
  locked_.resize(assembly.parts.size());
  for (const InitialOverlap& overlap : assembly.overlaps)
    if (const Certificate* lock = oracle.prove({{overlap.a, overlap.b}, ProofEffort::trivial, 1}, context)) {
      const PartId inside = lock->parts[0], other = lock->parts[1];
      if (find(inside) != find(other)) locked_[inside] = locked_[other] = true;
      root[find(inside)] = find(other);
    }
  Group all;
  // The last of its parts in the order says when a unit's turn is.
  const std::vector<PartId> order = ordered_parts(assembly, params.order);
  std::vector<UnitId> unit_of_root(assembly.parts.size(), kUnknown);
  for (auto id = order.rbegin(); id != order.rend(); ++id) {
    UnitId& unit = unit_of_root[find(*id)];
    if (unit == kUnknown) {
      unit = units_.size();
      units_.emplace_back();
    }
    units_[unit].push_back(*id);
  }
  std::reverse(units_.begin(), units_.end());
  std::stable_partition(units_.begin(), units_.end(), [&](const auto& parts) {  // others leave those that are locked
    return std::none_of(parts.begin(), parts.end(), [&](PartId id) { return locked_[id]; });
  });
  for (UnitId u = 0; u < units_.size(); ++u) {
    all.units.push_back(u);
    for (const PartId id : units_[u]) unit_of_[id] = u;
  }
  for (auto& unit : units_) std::sort(unit.begin(), unit.end());
  all.first = true;
  watched_.resize(units_.size());
  groups_.push_back(std::move(all));
  if (oracle.judge() != nullptr) proofs_ahead_ = std::make_unique<ProofsAhead>(oracle, context.executor);
  if (oracle.judge() != nullptr && params.straight) {
    directions_ = blocking::directions_of(assembly);
    relations_ = std::make_unique<Relations>(*oracle.judge(), directions_, context.executor);
  }
}

bool TakingApart::stop() {
  interrupted_ = interrupted_ || context_.should_stop();
  return interrupted_ || target_out_;
}

SequenceResult TakingApart::run() {
  while (!groups_.empty()) {
    Group group = std::move(groups_.front());
    groups_.pop_front();
    dismantle(std::move(group));
  }
  if (!target_out_)
    for (UnitId u = 0; u < units_.size(); ++u)
      if (unit_locked(u)) tell_locked(u);
  return finish();
}

/// What costs least and proves most comes first; after each removal from the beginning. A group that needs a deeper
/// search waits until the others have had theirs.
void TakingApart::dismantle(Group group) {
  while (group.units.size() > 1 && !stop()) {
    if (relations_ && oracle_.constraints().target && in_group(group, unit_of_[*oracle_.constraints().target]) &&
        remove_for_target(group))
      continue;
    if (relations_ && remove_free_unit(group)) continue;
    if (relations_ && params_.groups && !group.groups_done) {
      if (split(group)) continue;
      group.groups_done = true;
    }
    // How two bodies part is what path planners are for, and they give one way instead of many steps.
    if (params_.slide_states > 0 && oracle_.judge() != nullptr && group.units.size() > 2 && !group.slides_done) {
      if (slide(group)) continue;
      group.slides_done = true;
    }
    if (relations_ && params_.cages && (join_held(group) || join_confined_for_sure(group))) continue;
    if (relations_ && params_.turns && group.units.size() > 2 && !group.turns_done &&
        (group.depth > 1 || group.searched_out)) {
      if (turn(group)) continue;
      group.turns_done = true;
    }
    if (relations_ && params_.at_once && group.units.size() > 2) {
      if (together(group)) continue;
    }
    // Two that are left, with nobody to be fair to, are searched without limit at once; but if searches were in vain
    // that were not deep enough for a proof that they are held, that comes first.
    if (group.units.size() == 2 && !close_to_proof(group) &&
        std::none_of(groups_.begin(), groups_.end(), [](const Group& g) { return g.units.size() > 1; }))
      group.searched_out = true;
    if (!group.searched_out) {
      if (search(group)) continue;
      if (group.searched_out || groups_.empty() || stop()) continue;
      groups_.push_back(std::move(group));
      return;
    }
    if (group.units.size() == 2 && !group.pair_done) {
      // There is nobody else to turn to, in this group. But others may still be easier, and none may take all the time.
      const auto others = [&](auto&& has_more) {
        return std::any_of(groups_.begin(), groups_.end(),
                           [&](const Group& g) { return g.units.size() > 1 && has_more(g); });
      };
      if (!others([](const Group& g) { return !g.searched_out; })) {
        if (search_pair(group, other_pairs_wait())) continue;
        if (group.pair_done || stop()) continue;
      }
      groups_.push_back(std::move(group));
      return;
    }
    if (make_up_for(group)) continue;
    group.searches_done = true;  // what proofs are left to make is dear: they come after the searches of all groups
    if (std::any_of(groups_.begin(), groups_.end(),
                    [](const Group& g) { return g.units.size() > 1 && !g.searches_done; })) {
      groups_.push_back(std::move(group));
      return;
    }
    if (!relations_ || !params_.cages || (!join_flat(group) && !join_interlocked(group) && !join_confined(group)))
      break;
  }
  give_up(group);
}

bool TakingApart::in_group(const Group& group, UnitId unit) const {
  return std::find(group.units.begin(), group.units.end(), unit) != group.units.end();
}

/// Do the constraints let `units` leave what else is in the group?
bool TakingApart::may_leave(const Group& group, const std::vector<UnitId>& units) const {
  const Constraints& wishes = oracle_.constraints();
  const auto leaves = [&](PartId id) { return std::find(units.begin(), units.end(), unit_of_[id]) != units.end(); };
  const auto stays = [&](PartId id) { return !leaves(id) && in_group(group, unit_of_[id]); };
  if (std::any_of(wishes.base.begin(), wishes.base.end(), leaves)) return false;
  return std::none_of(wishes.before.begin(), wishes.before.end(),
                      [&](const auto& pair) { return leaves(pair.second) && stays(pair.first); });
}

std::vector<PartId> TakingApart::parts_of(const std::vector<UnitId>& units) const {
  std::vector<PartId> parts;
  for (const UnitId u : units) parts.insert(parts.end(), units_[u].begin(), units_[u].end());
  std::sort(parts.begin(), parts.end());
  return parts;
}

Attempt TakingApart::question(const Group& group, const std::vector<UnitId>& units) const {
  Attempt attempt;
  for (const PartId id : parts_of(units)) attempt.moving.push_back({id, poses_[id]});
  std::vector<UnitId> rest;
  for (const UnitId u : group.units)
    if (std::find(units.begin(), units.end(), u) == units.end()) rest.push_back(u);
  for (const PartId id : parts_of(rest)) attempt.still.push_back({id, poses_[id]});
  return attempt;
}

/// Notes where the parts are now, and who of them left the group: all, or the one that the answer names, or, when they
/// were only shifted, nobody.
void TakingApart::book(Group& group, const std::vector<UnitId>& units, const Attempt& attempt,
                       const AttemptResult& answer) {
  Removal removal;
  for (std::size_t i = 0; i < attempt.moving.size(); ++i) {
    const PartId id = attempt.moving[i].part;
    removal.parts.push_back(id);
    poses_[id] = answer.result.path.back()[i];
    if (relations_) turn_[id] = relations_->turn(poses_[id].q);
  }
  removal.attempt = &answer;
  removal.part_way = attempt.part_way;
  removals_.push_back(removal);
  std::vector<UnitId> out = units;
  if (answer.out) out = {unit_of_[*answer.out]};
  for (const UnitId u : units) watched_[u].clear();
  refused_.clear();
  group.slides_done = group.groups_done = group.turns_done = group.searched_out = group.searches_done = false;
  group.at_once = 0;
  if (attempt.part_way || out.size() < units.size()) {
    for (auto& known : watched_) known.clear();  // what was in the way may not be any more
    for (const UnitId u : group.units)
      for (const PartId id : units_[u]) tried_.erase(id);
    tried_at_once_.clear();
    moved_at_once_.clear();
  }
  if (attempt.part_way) {
    observer_.removed(removals_.back(), assembly_.parts.size() - out_);
    return;
  }
  std::erase_if(group.units, [&](UnitId u) { return std::find(out.begin(), out.end(), u) != out.end(); });
  ++out_;
  if (out.size() > 1) {
    Group own;
    own.units = out;
    std::sort(own.units.begin(), own.units.end());  // units are numbered in the order of trying
    groups_.push_back(std::move(own));
  }
  const auto& target = oracle_.constraints().target;
  if (target &&
      (out.size() == 1 ? unit_of_[*target] == out[0] : group.units.size() == 1 && group.units[0] == unit_of_[*target]))
    target_out_ = true;
  observer_.removed(removals_.back(), assembly_.parts.size() - out_);
  context_.progress("sequence", out_, units_.size() - 1, assembly_.parts[removal.parts.front()].name);
}

bool TakingApart::unit_locked(UnitId unit) const {
  return std::any_of(units_[unit].begin(), units_[unit].end(), [&](PartId id) { return locked_[id]; });
}

/// Parts of a unit that nothing can part have no way, and the oracle knows why.
void TakingApart::tell_locked(UnitId unit) {
  const auto& parts = units_[unit];  // a unit that was joined to another has none
  for (const PartId id : parts) {
    Attempt attempt;
    for (const PartId other : parts) (other == id ? attempt.moving : attempt.still).push_back({other, poses_[other]});
    Unsolved u;
    u.part = id;
    if (const auto held = held_.find(id); held != held_.end()) {
      u = held->second;
    } else if (locked_[id]) {
      const AttemptResult& answer = oracle_.attempt(attempt, context_);
      const PathResult& result = answer.result;
      u.certificate = answer.certificate;
      u.outcome = is_success(result.outcome) ? Outcome::exhausted : result.outcome;
      u.blocked_by = result.blocked_by;
      u.message = result.message;
    } else {
      u.message = "kept together with one that is locked";
    }
    unsolved_.push_back(std::move(u));
    if (std::find(remaining_.begin(), remaining_.end(), id) == remaining_.end()) remaining_.push_back(id);
  }
}

void TakingApart::give_up(const Group& group) {
  const std::vector<PartId> parts = parts_of(group.units);
  if (group.first || group.units.size() > 1) remaining_.insert(remaining_.end(), parts.begin(), parts.end());
  if (group.units.size() <= 1 || target_out_) return;
  for (const PartId id : parts) {
    if (unit_locked(unit_of_[id])) continue;  // told with the others of its kind
    const auto said = said_.find(id);
    Unsolved u;
    u.part = id;
    if (said != said_.end()) {
      u = said->second;
      std::erase_if(u.blocked_by, [&](PartId b) { return !std::binary_search(parts.begin(), parts.end(), b); });
    } else if (interrupted_) {
      u.outcome = context_.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout;
      u.message = "not tried: stopped before its turn";
    } else {
      u.message =
          may_leave(group, {unit_of_[id]}) ? "no straight way, and no search was made" : "the constraints hold it back";
    }
    for (const std::string& said_too : {group.slides_said, group.at_once_said})
      if (!said_too.empty()) u.message += (u.message.empty() ? "" : "; ") + said_too;
    unsolved_.push_back(std::move(u));
  }
}

SequenceResult TakingApart::finish() const {
  SequenceResult result;
  result.removals = removals_;
  result.remaining = remaining_;
  result.unsolved = unsolved_;
  result.counts = counts_;
  if (relations_) result.counts["relations"] = static_cast<double>(relations_->computed());
  if (unsolved_.empty()) {
    result.outcome = Outcome::solved;
    return result;
  }
  const auto any = [&](Outcome o) {
    return std::any_of(unsolved_.begin(), unsolved_.end(), [&](const Unsolved& u) { return u.outcome == o; });
  };
  result.outcome = Outcome::exhausted;
  const auto all = [&](Outcome o) {
    return std::all_of(unsolved_.begin(), unsolved_.end(), [&](const Unsolved& u) { return u.outcome == o; });
  };
  if (any(Outcome::depth_limit)) result.outcome = Outcome::depth_limit;
  if (any(Outcome::timeout)) result.outcome = Outcome::timeout;
  for (const Outcome o : {Outcome::invalid_start, Outcome::unsupported, Outcome::infeasible})
    if (all(o)) result.outcome = o;
  if (interrupted_) result.outcome = context_.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout;
  if (any(Outcome::crashed)) result.outcome = Outcome::crashed;
  return result;
}

}  // namespace dismantle::blocking
