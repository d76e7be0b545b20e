#include "one_by_one/one_by_one.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace dismantle {

std::vector<PartId> ordered_parts(const Assembly& assembly, PartOrder order) {
  std::vector<PartId> parts(assembly.parts.size());
  std::iota(parts.begin(), parts.end(), PartId{0});
  const auto volume = [&](PartId id) { return assembly.parts[id].volume; };
  if (order == PartOrder::small_first)
    std::stable_sort(parts.begin(), parts.end(), [&](PartId a, PartId b) { return volume(a) < volume(b); });
  if (order == PartOrder::large_first)
    std::stable_sort(parts.begin(), parts.end(), [&](PartId a, PartId b) { return volume(a) > volume(b); });
  return parts;
}

OneByOne::OneByOne(const Assembly& assembly, std::vector<PartId> parts, PathOracle& oracle, SequenceObserver& observer,
                   RunContext& context)
    : assembly_(assembly),
      oracle_(oracle),
      observer_(observer),
      context_(context),
      left_(std::move(parts)),
      last_(assembly.parts.size()) {}

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
  attempt.moving.push_back({part, Pose{}});
  for (const PartId id : left_)
    if (id != part) attempt.fixed.push_back({id, Pose{}});
  return attempt;
}

Outcome OneByOne::attempt(PartId part, unsigned max_depth, std::span<const PartId> next) {
  context_.progress("sequence", removals_.size(), assembly_.parts.size() - 1, assembly_.parts[part].name);
  if (context_.threads > 1) {
    std::vector<Attempt> ahead{question(part, max_depth)};
    // Two attempts per thread keep all threads busy while an answer is recorded.
    for (const PartId id : next.first(std::min<std::size_t>(next.size(), 2 * context_.threads)))
      ahead.push_back(question(id, max_depth));
    oracle_.prefetch(ahead, context_);
  }
  const AttemptResult& answer = oracle_.attempt(question(part, max_depth), context_);
  answer_ = &answer;
  const PathResult& result = answer.result;
  if (is_success(result.outcome())) {
    std::erase(left_, part);
    last_[part].reset();
    removals_.push_back({{part}, &answer});
    observer_.removed(removals_.back(), left_.size());
    context_.progress("sequence", removals_.size(), assembly_.parts.size() - 1, assembly_.parts[part].name);
  } else if (!interrupted() || !last_[part]) {  // an interrupted attempt says less than the one before it
    last_[part] =
        Unsolved{part, result.outcome(), result.blocked_by, result.best_pose, result.message, answer.certificate};
  }
  return result.outcome();
}

// The outcome of the run. A crash comes first, then an outcome that all parts share, then outcomes that more effort
// could change.
Outcome OneByOne::outcome() const {
  if (done()) return Outcome::solved;
  if (interrupted_) return why_;
  const auto any = [&](Outcome o) {
    return std::any_of(left_.begin(), left_.end(), [&](PartId id) { return last_[id] && last_[id]->outcome == o; });
  };
  const auto all = [&](Outcome o) {
    return std::all_of(left_.begin(), left_.end(), [&](PartId id) { return last_[id] && last_[id]->outcome == o; });
  };
  if (any(Outcome::crashed)) return Outcome::crashed;
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
      std::erase_if(blockers, [&](PartId b) { return std::find(left_.begin(), left_.end(), b) == left_.end(); });
    } else {
      result.unsolved.push_back(
          {id, interrupted_ ? why_ : Outcome::exhausted, {}, {}, "not tried: stopped before its turn"});
    }
  }
  return result;
}

}  // namespace dismantle
