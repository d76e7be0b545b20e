#include "one_by_one/one_by_one.h"

#include <algorithm>
#include <string>
#include <utility>

#include "dismantle/part_set.h"

namespace dismantle {

std::vector<EnumChoice<PartOrder>> part_orders() {
  return {{"small_first", PartOrder::small_first, "ascending volume: screws and pins before the housing"},
          {"as_given", PartOrder::as_given, "as the assembly lists its parts"},
          {"large_first", PartOrder::large_first, "descending volume"}};
}

std::vector<PlacedPart> ordered_group(const Assembly& assembly, std::vector<PlacedPart> group, PartOrder order) {
  const auto volume = [&](const PlacedPart& p) { return assembly.parts[p.part].volume; };
  const auto smaller = [&](const PlacedPart& a, const PlacedPart& b) { return volume(a) < volume(b); };
  if (order == PartOrder::small_first) std::stable_sort(group.begin(), group.end(), smaller);
  if (order == PartOrder::large_first)
    std::stable_sort(group.begin(), group.end(), [&](const auto& a, const auto& b) { return smaller(b, a); });
  return group;
}

std::vector<PartId> ordered_parts(const Assembly& assembly, PartOrder order) {
  return ids_of(ordered_group(assembly, whole_assembly(assembly).front(), order));
}

OneByOne::OneByOne(const Assembly& assembly, const std::vector<PlacedPart>& group, PathOracle& oracle,
                   SequenceObserver& observer, RunContext& context)
    : assembly_(assembly),
      oracle_(oracle),
      observer_(observer),
      context_(context),
      left_(ids_of(group)),
      poses_(assembly.parts.size()),
      steps_(group.size() - 1),
      last_(assembly.parts.size()) {
  for (const PlacedPart& p : group) poses_[p.part] = p.pose;
}

bool OneByOne::interrupted() {
  if (!interrupted_ && context_.should_stop()) {
    interrupted_ = true;
    why_ = context_.cancel.cancelled() ? Outcome::cancelled : Outcome::timeout;
  }
  return interrupted_;
}

Attempt OneByOne::question(PartId part, unsigned max_depth) const {
  Attempt attempt;
  attempt.max_depth = max_depth;
  attempt.moving.push_back({part, poses_[part]});
  for (const PartId id : left_)
    if (id != part) attempt.fixed.push_back({id, poses_[id]});
  return attempt;
}

const AttemptResult& OneByOne::ask(PartId part, unsigned max_depth, std::span<const PartId> next) {
  context_.progress("sequence", removals_.size(), steps_, assembly_.parts[part].name);
  if (context_.threads > 1) {
    std::vector<Attempt> ahead{question(part, max_depth)};
    // Two attempts per thread keep all threads busy while an answer is recorded.
    for (const PartId id : next.first(std::min<std::size_t>(next.size(), 2 * context_.threads)))
      ahead.push_back(question(id, max_depth));
    oracle_.prefetch(ahead, context_);
  }
  answer_ = &oracle_.attempt(question(part, max_depth), context_);
  return *answer_;
}

void OneByOne::remove(PartId part, const AttemptResult& answer) {
  std::erase(left_, part);
  last_[part].reset();
  removals_.push_back({{part}, &answer});
  observer_.removed(removals_.back(), left_.size());
  context_.progress("sequence", removals_.size(), steps_, assembly_.parts[part].name);
}

void OneByOne::note_failure(PartId part, const AttemptResult& answer) {
  const PathResult& result = answer.result;
  if (!interrupted() || !last_[part])  // an interrupted attempt says less than the one before it
    last_[part] =
        Unsolved{part, result.outcome(), result.blocked_by, result.best_pose, result.message, answer.certificate};
}

Outcome OneByOne::attempt(PartId part, unsigned max_depth, std::span<const PartId> next) {
  const AttemptResult& answer = ask(part, max_depth, next);
  if (is_success(answer.result.outcome()))
    remove(part, answer);
  else
    note_failure(part, answer);
  return answer.result.outcome();
}

std::vector<Outcome> OneByOne::attempt_each(std::span<const PartId> parts, unsigned max_depth, Preference& preference) {
  std::vector<Outcome> outcomes;
  std::vector<const AttemptResult*> found;
  for (std::size_t i = 0; i < parts.size() && !interrupted(); ++i) {
    const AttemptResult& answer = ask(parts[i], max_depth, parts.subspan(i + 1));
    outcomes.push_back(answer.result.outcome());
    if (is_success(outcomes.back()))
      found.push_back(&answer);
    else
      note_failure(parts[i], answer);
  }
  for (bool first = true; !found.empty() && !done() && !interrupted(); first = false) {
    std::vector<CandidateRemoval> candidates;
    for (const AttemptResult* answer : found) {
      Attempt now = question(answer->attempt.moving.front().part, max_depth);
      candidates.push_back({std::move(now.moving), std::move(now.fixed), Eigen::Vector3d::Zero(), &answer->path()});
    }
    const std::size_t best = preference.sorted(candidates, context_).front();
    const PartId part = candidates[best].moving.front().part;
    // The first answer is about all parts that are left; the others were given before parts left.
    const AttemptResult& answer =
        first ? *found[best] : oracle_.propose(question(part, max_depth), found[best]->path(), context_);
    if (is_success(answer.result.outcome())) {
      preference.removed(candidates[best], answer.path(), context_);
      remove(part, answer);
    }
    found.erase(found.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return outcomes;
}

// The outcome of the run. A crash comes first, then an outcome that all parts share, then outcomes that more effort
// could change.
Outcome OneByOne::outcome() const {
  if (done()) return Outcome::solved;
  if (interrupted_ && why_ == Outcome::cancelled) return why_;
  const auto any = [&](Outcome o) {
    return std::any_of(left_.begin(), left_.end(), [&](PartId id) { return last_[id] && last_[id]->outcome == o; });
  };
  const auto all = [&](Outcome o) {
    return std::all_of(left_.begin(), left_.end(), [&](PartId id) { return last_[id] && last_[id]->outcome == o; });
  };
  if (any(Outcome::crashed)) return Outcome::crashed;
  if (interrupted_) return why_;
  for (const Outcome o : {Outcome::invalid_start, Outcome::unsupported, Outcome::infeasible})
    if (all(o)) return o;
  if (any(Outcome::timeout)) return Outcome::timeout;
  if (any(Outcome::depth_limit)) return Outcome::depth_limit;
  return Outcome::exhausted;
}

SequenceResult OneByOne::finish() const {
  SequenceResult result;
  result.outcome = outcome();
  result.removals = removals_;
  result.remaining = left_;
  if (done()) return result;
  for (const PartId id : left_) {
    if (last_[id]) {
      result.unsolved.push_back(*last_[id]);
      auto& blockers = result.unsolved.back().blocked_by;
      std::erase_if(blockers, [&](PartId b) { return !contains(left_, b); });
    } else {
      result.unsolved.push_back(
          {id, interrupted_ ? why_ : Outcome::exhausted, {}, {}, "not tried: stopped before its turn"});
    }
  }
  return result;
}

SequenceResult each_group(const SequenceQuery& query,
                          const std::function<SequenceResult(const std::vector<PlacedPart>& group)>& take_apart) {
  SequenceResult all;
  all.outcome = Outcome::solved;
  for (const std::vector<PlacedPart>& group : query.start) {
    const SequenceResult one = take_apart(group);
    if (all.outcome == Outcome::solved) all.outcome = one.outcome;
    all.removals.insert(all.removals.end(), one.removals.begin(), one.removals.end());
    all.remaining.insert(all.remaining.end(), one.remaining.begin(), one.remaining.end());
    all.unsolved.insert(all.unsolved.end(), one.unsolved.begin(), one.unsolved.end());
    for (const auto& [name, count] : one.counts) all.counts[name] += count;
  }
  return all;
}

}  // namespace dismantle
