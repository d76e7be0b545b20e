#include "blocking/strategies/partial_translation.h"

#include <algorithm>
#include <cmath>

#include "dismantle/geometry/numerics.h"

namespace dismantle::blocking {
namespace {

bool is_translation(const Pose& p) { return p.q.vec().cwiseAbs().maxCoeff() == 0; }

}  // namespace

PartialTranslation::PartialTranslation(DisassemblyState& state, PathOracle& oracle, StraightMotion* straight,
                                       const PartialTranslationParams& params)
    : state_(state),
      oracle_(oracle),
      straight_(straight),
      params_(params),
      translations_(state.assembly(), oracle.tolerance(), params) {}

/// A pair is left to the path planner, which returns one path instead of many steps.
Result PartialTranslation::apply(GroupState& group) {
  Progress& progress = progress_[group];
  const bool more_effort = group.translations_limited && group.search_depth > progress.depth;
  if (group.members.size() < 3 || (progress.done && !more_effort)) return Result::unchanged;
  if (search(group)) return Result::restart;
  progress.done = true;
  progress.depth = group.search_depth;
  return Result::unchanged;
}

/// Makes the translations that are found. After a refusal the search is repeated without the refused translation.
bool PartialTranslation::search(GroupState& group) {
  const auto suits = [&](SubassemblyId s) {
    return state_.is_single(s) && is_translation(state_.pose(state_.part_of(s)));
  };
  if (!std::all_of(group.members.begin(), group.members.end(), suits)) return false;
  for (unsigned refusals = 0; refusals < params_.translation_refusals && !state_.stop(); ++refusals) {
    const TranslationSearch::Answer found = find(group);
    if (found.end != TranslationSearch::End::found) return false;
    for (const Translation& slide : found.translations) {
      const Made made = make(group, slide);
      if (made == Made::removed) return true;
      if (made == Made::impossible) return false;
      if (made == Made::refused) break;
    }
  }
  return false;
}

TranslationSearch::Answer PartialTranslation::find(GroupState& group) {
  Places places;
  for (const PartId id : state_.parts_of(group.members)) places[id] = state_.pose(id).t;
  const double work = params_.translation_work * std::pow(params_.translation_work_growth, group.search_depth - 1);
  TranslationSearch::Answer found =
      translations_.search(places, static_cast<std::size_t>(params_.translation_states), work, state_.context());
  using End = TranslationSearch::End;
  group.translations_limited = found.end == End::too_long;
  group.translations_exhausted = found.end == End::exhausted;
  state_.count("translation_states", static_cast<double>(found.states));
  std::string& note = progress_[group].note;
  if (found.end == End::exhausted)
    note = std::to_string(found.states) +
           " arrangements can be reached by translations between places where faces are flush, and in none of them "
           "a part or group is free";
  if (found.end == End::limit || found.end == End::too_long)
    note =
        "translations to intermediate placements were given up after " + std::to_string(found.states) + " arrangements";
  if (found.end == End::found) note.clear();
  return found;
}

PartialTranslation::Made PartialTranslation::make(GroupState& group, const Translation& slide) {
  // Moving the rest along the opposite direction is equivalent. The smaller set moves, as a user expects.
  Subassemblies ids;
  for (const PartId id : slide.parts) ids.push_back(state_.subassembly_of(id));
  Eigen::Vector3d direction = slide.direction;
  Subassemblies rest = state_.others(group, ids);
  if (rest.size() < ids.size() || (!state_.may_leave(group, ids) && state_.may_leave(group, rest))) {
    std::swap(ids, rest);
    direction = -direction;
  }
  if (!std::isinf(slide.length)) {
    const AttemptResult* answer = nullptr;
    if (translate(group, ids, slide.length * direction, answer)) return Made::yes;
    forbid(group, ids, direction, answer);
    return Made::refused;
  }
  if (straight_ == nullptr || !state_.may_leave(group, ids)) return Made::impossible;
  const auto& directions = straight_->directions().all;
  const auto known = std::find_if(directions.begin(), directions.end(), [&](const Eigen::Vector3d& d) {
    return d.dot(direction) > geometry::kSameDirection;
  });
  if (known == directions.end()) return Made::impossible;
  if (straight_->leave(group, ids, static_cast<std::size_t>(known - directions.begin()))) return Made::removed;
  forbid(group, ids, direction, nullptr);
  return Made::refused;
}

/// Moves `ids` by a translation and leaves them there, if the verifier accepts it.
bool PartialTranslation::translate(GroupState& group, const Subassemblies& ids, const Eigen::Vector3d& by,
                                   const AttemptResult*& answer) {
  Attempt attempt = state_.attempt_for(group, ids);
  attempt.goal.placement = true;
  Path path(2);
  for (const auto& p : attempt.moving) {
    path[0].push_back(p.pose);
    path[1].push_back({p.pose.t + by, p.pose.q});
  }
  answer = &oracle_.propose(attempt, path, state_.context());
  if (!is_success(answer->result.outcome())) return false;
  state_.commit(group, ids, attempt, *answer, GroupChange::Kind::translated);
  state_.count("translations");
  return true;
}

/// Blocks the direction in the search: for the first part that the refusal names, or for all if it names none.
void PartialTranslation::forbid(const GroupState& group, const Subassemblies& ids, const Eigen::Vector3d& direction,
                                const AttemptResult* refusal) {
  const bool named = refusal != nullptr && !refusal->result.blocked_by.empty();
  const std::vector<PartId> moving = state_.parts_of(ids);
  for (const PartId m : moving)
    for (const PartId f : state_.parts_of(group.members))
      if (!std::binary_search(moving.begin(), moving.end(), f) && (!named || refusal->result.blocked_by.front() == f))
        translations_.forbid(m, f, state_.pose(m).t - state_.pose(f).t, direction);
}

void PartialTranslation::on_group_changed(GroupState& group, const GroupChange&) { progress_[group].done = false; }

std::string PartialTranslation::failure_note(const GroupState& group) const {
  const Progress* progress = progress_.find(group);
  return progress == nullptr ? std::string() : progress->note;
}

}  // namespace dismantle::blocking
