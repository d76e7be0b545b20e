#include "blocking/strategies/partial_translation.h"

#include <algorithm>
#include <cmath>

#include "dismantle/geometry/numerics.h"

namespace dismantle::blocking {
namespace {

bool is_translation(const Pose& p) { return p.q.vec().cwiseAbs().maxCoeff() == 0; }

// Looking up an arrangement on a grid takes about as long as comparing ten pairs of edges.
constexpr double kWorkOfArrangement = 0.1;
// Proofs for the whole tolerance are about all motions, those for less explain why no motion was found.
constexpr double kShareOfProof = 0.5;

}  // namespace

PartialTranslation::PartialTranslation(DisassemblyState& state, PathOracle& oracle, const PairSweep& sweep,
                                       StraightMotion* straight, SnapFits& snaps,
                                       const PartialTranslationParameters& params)
    : state_(state),
      oracle_(oracle),
      straight_(straight),
      snaps_(snaps),
      params_(params),
      translations_(state.assembly(), oracle.tolerance(), params),
      on_grid_(state.assembly(), sweep) {}

/// A pair that does not lie on a grid is left to the path planner, which returns one path instead of many steps.
Result PartialTranslation::apply(GroupState& group) {
  Progress& progress = progress_[group];
  const bool more_effort = group.translations_limited && group.search_depth > progress.depth;
  if (progress.done && !more_effort) return Result::unchanged;
  if (group.is_pair() ? take_pair_apart(group) : search(group)) return Result::restart;
  progress.done = true;
  progress.depth = group.search_depth;
  return Result::unchanged;
}

bool PartialTranslation::suits(const GroupState& group) const {
  return std::all_of(group.members.begin(), group.members.end(), [&](SubassemblyId s) {
    return state_.is_single(s) && is_translation(state_.pose(state_.part_of(s)));
  });
}

/// Makes the translations that are found. After a refusal the search is repeated without the refused translation.
bool PartialTranslation::search(GroupState& group) {
  if (!suits(group)) return false;
  for (unsigned refusals = 0; refusals < params_.translation_refusals && !state_.stop(); ++refusals) {
    const TranslationSearch::Answer found = find(group);
    if (found.end != TranslationSearch::End::found) return false;
    for (const Translation& slide : found.translations) {
      const Made made = make(group, slide);
      if (made == Made::removed) return true;
      if (made == Made::impossible) return false;
      if (made == Made::refused) {
        progress_[group].off_grid = true;
        break;
      }
    }
  }
  return false;
}

/// One path of several translations, of the smaller part.
bool PartialTranslation::take_pair_apart(GroupState& group) {
  if (straight_ == nullptr || !suits(group)) return false;
  const TranslationSearch::Answer found = find(group);
  if (found.end != TranslationSearch::End::found) return false;
  const SubassemblyId housing = state_.housing_of(group);
  Subassemblies ids = state_.others(group, {housing});
  if (!state_.may_leave(group, ids)) ids = {housing};
  if (!state_.may_leave(group, ids)) return false;
  const Attempt attempt = state_.attempt_for(group, ids);
  Eigen::Vector3d by = Eigen::Vector3d::Zero();
  Path path{{attempt.moving.front().pose}};
  for (const Translation& slide : found.translations) {
    const double sign = slide.parts.front() == attempt.moving.front().part ? 1 : -1;
    const auto direction = straight_direction(sign * slide.direction);
    if (!direction) return false;
    const Eigen::Vector3d& d = straight_->directions().all[*direction];
    by += (std::isinf(slide.length) ? straight_->length_out(group, ids, *direction, by) : slide.length) * d;
    path.push_back({{attempt.moving.front().pose.t + by, attempt.moving.front().pose.q}});
  }
  const AttemptResult& answer = oracle_.propose(attempt, path, state_.context());
  if (!is_success(answer.result.outcome())) return false;
  state_.commit(group, ids, attempt, answer, GroupChange::Kind::removed);
  state_.count("translations", static_cast<double>(found.translations.size()));
  return true;
}

/// The number of this direction among those of straight removals.
std::optional<std::size_t> PartialTranslation::straight_direction(const Eigen::Vector3d& direction) const {
  const auto& directions = straight_->directions().all;
  const auto known = std::find_if(directions.begin(), directions.end(), [&](const Eigen::Vector3d& d) {
    return d.dot(direction) > geometry::kSameDirection;
  });
  if (known == directions.end()) return std::nullopt;
  return static_cast<std::size_t>(known - directions.begin());
}

TranslationSearch::Answer PartialTranslation::find(GroupState& group) {
  using End = TranslationSearch::End;
  Places places;
  for (const PartId id : state_.parts_of(group.members)) places[id] = state_.pose(id).t;
  const double work = params_.translation_work * std::pow(params_.translation_work_growth, group.search_depth - 1);
  const auto most_states = static_cast<std::size_t>(params_.translation_states);
  Progress& progress = progress_[group];
  TranslationSearch::Answer found;
  if (!progress.off_grid) {
    found = on_grid_.search(places, most_states, kWorkOfArrangement * work, state_.context());
    state_.context().log(LogLevel::debug, on_grid_.summary(found));
    if (found.end == End::exhausted) prove(group);
    progress.off_grid = found.end == End::unsuited || (found.end == End::exhausted && group.proof == nullptr);
  }
  bool hopeless = false;
  if (progress.off_grid && !group.is_pair()) {
    const std::size_t on_grid = found.states;
    found = translations_.search(places, most_states, work, state_.context());
    state_.context().log(LogLevel::debug, "translations between flush places: " + std::to_string(found.states) +
                                              " arrangements of " + std::to_string(places.size()) + " parts, " +
                                              std::to_string(found.waiting) + " waiting");
    hopeless = found.hopeless();
    found.states += on_grid;
  }
  group.translations_limited = found.end == End::too_long && !hopeless && !snaps_.holds_all(group);
  group.translations_exhausted = found.end == End::exhausted;
  state_.count("translation_states", static_cast<double>(found.states));
  std::string& note = progress.note;
  note.clear();
  if (found.end == End::exhausted && group.proof == nullptr)
    note = std::to_string(found.states) +
           " arrangements can be reached by translations between places where faces are flush, and in none of them "
           "a part or group is free";
  if (found.end == End::limit || found.end == End::too_long || found.end == End::stopped)
    note = "translations to intermediate placements were given up after " + std::to_string(found.states) +
           " arrangements, " + std::to_string(found.waiting) + " more were waiting";
  return found;
}

/// All arrangements on the grid were visited: asks for the proof that no translations separate the group.
void PartialTranslation::prove(GroupState& group) {
  std::vector<PartId> parts = state_.parts_of(group.members);
  group.proof = oracle_.prove({parts, ProofEffort::low, kShareOfProof}, state_.context());
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
  const auto known = straight_direction(direction);
  if (!known) return Made::impossible;
  if (straight_->leave(group, ids, *known)) return Made::removed;
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
  state_.context().log(LogLevel::debug, "translation of " + std::to_string(ids.size()) +
                                            " parts: " + std::string(to_string(answer->result.outcome())) + " " +
                                            answer->result.message);
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

void PartialTranslation::on_group_changed(GroupState& group, const GroupChange& change) {
  progress_[group].done = false;
  if (change.moves_remaining()) return;
  progress_[group].off_grid = false;
  group.proof = nullptr;
}

std::string PartialTranslation::failure_note(const GroupState& group) const {
  const Progress* progress = progress_.find(group);
  return progress == nullptr ? std::string() : progress->note;
}

}  // namespace dismantle::blocking
