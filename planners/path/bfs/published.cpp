#include "published.h"

#include <algorithm>

#include "dismantle/path/resume.h"
#include "dismantle/search/time_limit.h"

namespace dismantle::bfs {

PublishedSearch::PublishedSearch(const PathQuery& query, const Parameters& parameters, RunContext& context)
    : query_(query),
      parameters_(parameters),
      context_(context),
      deadline_(path::deadline_of(query, context)),
      steps_left_(query.budget.max_steps) {
  const auto* reached = dynamic_cast<const ReachedLevels*>(query.resume_from);
  if (reached != nullptr && reached->fixed == path::fixed_parts(query.scene)) earlier_ = reached;
  now_.fail(Outcome::depth_limit);
}

LevelSearch& PublishedSearch::search(MotionSpace space) {
  const bool turns = space == MotionSpace::rigid;
  std::optional<LevelSearch>& search = turns ? rigid_ : translation_;
  if (!search) {
    const std::optional<Levels>* levels = earlier_ == nullptr ? nullptr
                                          : turns             ? &earlier_->rigid
                                                              : &earlier_->translation;
    search.emplace(query_, space, parameters_, context_, levels != nullptr && *levels ? &**levels : nullptr);
  }
  return *search;
}

std::uint64_t PublishedSearch::steps() const {
  std::uint64_t steps = 0;
  PathResult counted;
  for (const auto* search : {&translation_, &rigid_})
    if (*search) (*search)->report(counted), steps += counted.stats.steps;
  return steps;
}

/// Returns nothing if the search continues.
std::optional<SearchStatus> PublishedSearch::run_level(MotionSpace space, const Deadline& end,
                                                       std::uint64_t pause_after) {
  LevelSearch& search = this->search(space);
  if (depth_ == 1 && search.starts_out()) {
    now_.start_is_goal();
    return SearchStatus::solved;
  }
  using End = LevelSearch::End;
  switch (search.run(depth_, end, query_.budget.max_steps > 0 ? &steps_left_ : nullptr, pause_after, now_)) {
    case End::searched:
      return std::nullopt;
    case End::solved:
      return SearchStatus::solved;
    case End::paused:
      return SearchStatus::paused;
    case End::refused:
      now_.fail(Outcome::exhausted);
      return SearchStatus::exhausted;
    case End::stopped:
      break;
  }
  if (context_.cancel.cancelled()) {
    now_.fail(Outcome::cancelled);
    return SearchStatus::failed;
  }
  const bool over = deadline_.passed() || (query_.budget.max_steps > 0 && steps_left_ == 0);
  if (over) now_.fail(Outcome::timeout);
  return over ? status_of(Outcome::timeout) : SearchStatus::paused;
}

SearchStatus PublishedSearch::run(const Budget& portion) {
  if (is_success(now_.outcome())) return SearchStatus::solved;
  if (now_.outcome() != Outcome::depth_limit) return status_of(now_.outcome());
  const Deadline end = deadline_.earlier(path::deadline_of(portion));
  const std::uint64_t before = steps();
  const bool translates = parameters_.motion != push::Motion::rotation;
  const bool turns = parameters_.motion != push::Motion::translation;
  const unsigned most = query_.budget.max_depth;
  while (most == 0 || depth_ <= most) {
    const bool turns_now = turns && (depth_ > 1 || !translates);
    for (const MotionSpace space : {MotionSpace::translation, MotionSpace::rigid}) {
      if (space == MotionSpace::translation ? !translates || turning_ : !turns_now) continue;
      const std::uint64_t done = steps() - before;
      if (portion.max_steps > 0 && done >= portion.max_steps) return SearchStatus::paused;
      if (const auto status = run_level(space, end, portion.max_steps > 0 ? portion.max_steps - done : 0))
        return *status;
      turning_ = true;
    }
    turning_ = false;
    const bool all = (!translates || translation_->exhausted()) && (!turns || (rigid_ && rigid_->exhausted()));
    if (all) {
      now_.fail(Outcome::exhausted);
      return SearchStatus::exhausted;
    }
    ++depth_;
  }
  return status_of(now_.outcome());
}

PathResult PublishedSearch::result() {
  PathResult result = now_;
  std::shared_ptr<ReachedLevels> reached;
  if (result.outcome() == Outcome::depth_limit || result.outcome() == Outcome::exhausted) {
    reached = std::make_shared<ReachedLevels>();
    reached->fixed = path::fixed_parts(query_.scene);
  }
  PathResult all;
  for (const auto* search : {&translation_, &rigid_}) {
    if (!*search) continue;
    PathResult part;
    (*search)->report(part);
    all.stats += part.stats;
    for (const PartId p : part.blocked_by)
      if (std::find(all.blocked_by.begin(), all.blocked_by.end(), p) == all.blocked_by.end())
        all.blocked_by.push_back(p);
    all.best_pose = part.best_pose;
    if (reached) (search == &rigid_ ? reached->rigid : reached->translation) = (*search)->levels();
  }
  result.stats = all.stats;
  result.blocked_by = all.blocked_by;
  result.best_pose = all.best_pose;
  if (is_success(result.outcome())) result.message.clear();
  result.state = std::move(reached);
  return result;
}

}  // namespace dismantle::bfs
