#include "with_others.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "dismantle/executor.h"
#include "dismantle/free_space/led_walk.h"
#include "dismantle/push/plan.h"
#include "dismantle/tolerant_walk/walk.h"
#include "growth.h"

namespace dismantle::guided {
namespace {

/// A walk is not worth its while in searches that are less deep.
constexpr unsigned kLeastDepth = 3;
/// Likewise one that is led, of which it takes fewer looks to see that it gets nowhere.
constexpr unsigned kLeastDepthOfLead = 2;
/// What is so large is dear to lead, and there is little room for it to be led through: diagonals of boxes, of what
/// moves to what stays, and the least depth.
constexpr double kLarge = 0.5;
constexpr unsigned kLeastDepthOfLarge = 4;

Aabb box_of(const Assembly& assembly, const std::vector<PlacedPart>& parts) {
  Aabb box;
  for (const auto& p : parts)
    for (const auto& v : assembly.parts[p.part].mesh->vertices) box.extend(p.pose * v);
  return box;
}

bool is_large(const PathQuery& query) {
  const Aabb moving = box_of(query.assembly, query.cast.moving), still = box_of(query.assembly, query.cast.still);
  return moving.empty() || still.empty() || moving.size().norm() > kLarge * still.size().norm();
}

/// Nothing was found and nobody stopped it: it may go on, or has nothing left.
bool undecided(const PathResult& r) { return r.outcome() == Outcome::depth_limit || r.outcome() == Outcome::exhausted; }

/// Pauses the search that runs beside while a path is checked.
class PausingChecker final : public PathChecker {
 public:
  /// Both outlive it.
  PausingChecker(Executor& executor, const PathChecker& checker) : executor_(executor), checker_(checker) {}
  PathCheck check(const Path& path) const override {
    const Executor::PauseScope pause(executor_);
    return checker_.check(path);
  }

 private:
  Executor& executor_;
  const PathChecker& checker_;
};

PathQuery with_checker(const PathQuery& query, const PathChecker& checker) {
  return {query.assembly,  query.simulator, query.prepared, query.cast,       query.budget,
          query.tolerance, checker,         query.goal,     query.resume_from};
}

/// What each of them has reached; null where it was not begun, or has found that there is nothing to begin with.
class Reached final : public SearchState {
 public:
  using One = std::shared_ptr<const SearchState>;
  One pushed, led, led_thin, squeezed;
};

class Others {
 public:
  Others(const PathQuery& query, const Parameters& parameters, const push::Tactics& tactics,
         tolerant_walk::GeometryCache& cache, RunContext& context)
      : Others(query, parameters, tactics, cache, context, free_space::overlaps_through(query)) {}

  /// The walk that is led, and then the rest, which an idle thread may begin meanwhile.
  PathResult under_depth_limit() {
    const unsigned depth = query_.budget.max_depth;
    if (depth >= kLeastDepthOfLarge || (depth >= kLeastDepthOfLead && !is_large(query_))) {
      RunContext own = context_;
      own.cancel = CancelToken();
      own.on_progress = nullptr;
      own.on_log = nullptr;
      std::optional<Others> rest;
      std::optional<PausingChecker> pausing;
      Executor::TaskHandle beside;
      if (context_.executor && context_.executor->threads() > 1 && limits_.steps_left == nullptr) {
        // If a candidate path of the walk is accepted, the rest is not needed: it pauses while one is verified.
        Executor& executor = *context_.executor;
        rest.emplace(Others(query_, parameters_, tactics_, cache_, own, thin_));
        pausing.emplace(executor, query_.checker);
        beside = executor.submit([&] { rest->push_and_walk([&] { executor.pause_point(); }); },
                                 Executor::Priority::fork_join);
      }
      lead(with_checker(query_, pausing ? static_cast<const PathChecker&>(*pausing) : query_.checker),
           depth <= kLeastDepthOfLead ? 1 : 0);
      if (!undecided(led_)) {
        own.cancel.cancel();
        return together(led_);
      }
      if (beside && !beside.withdraw()) {
        beside.wait(context_, own.cancel);
        pushes_ = rest->pushes_;
        squeezed_ = rest->squeezed_;
        return pushed_or_walked();
      }
    }
    push_and_walk();
    return pushed_or_walked();
  }

  PathResult by_turns() {
    const PathQuery to_push = from(query_, &Reached::pushed);
    push::ByTurns pushing(to_push, tactics_, context_);
    const auto most = static_cast<std::uint64_t>(parameters_.forest_steps);
    std::optional<tunnel_forest::Growth> growth;
    if (thin_) limits_.pause_after /= kLeadThinAfter;
    bool pushing_ends = false, forest_ends = most == 0, walked = false;
    while (!pushing_ends || !forest_ends) {
      if (!pushing_ends) {
        pushes_ = pushing.run(limits_);
        if (!undecided(pushes_)) return together(pushes_);
        pushes_.state = pushing.reached();
        pushing_ends = !pushing.paused();
      }
      if (!walked) {
        lead(query_, 0);
        if (!undecided(led_)) return together(led_);
        walk(static_cast<double>(parameters_.squeeze_looks));
        walked = true;
        if (!undecided(squeezed_)) return together(squeezed_);
        limits_.pause_after = static_cast<std::uint64_t>(parameters_.forest_after);
        if (thin_ && !pushing_ends) continue;
      }
      if (!forest_ends) {
        if (!growth) growth.emplace(tunnel_forest::Parameters{}, query_, context_, most);
        const std::uint64_t before = growth->used();
        growth->run({.max_steps = std::min(steps_left_, limits_.pause_after)});
        forest_ = growth->result();
        spend(growth->used() - before);
        if (!undecided(forest_)) return together(forest_);
        if (steps_left_ == 0) {
          forest_.fail(Outcome::timeout);
          return together(forest_);
        }
        forest_ends = forest_.outcome() == Outcome::exhausted || growth->used() >= most;
      }
      limits_.pause_after *= 2;
    }
    return together(pushes_);
  }

 private:
  Others(const PathQuery& query, const Parameters& parameters, const push::Tactics& tactics,
         tolerant_walk::GeometryCache& cache, RunContext& context, bool thin)
      : query_(query),
        parameters_(parameters),
        tactics_(tactics),
        cache_(cache),
        context_(context),
        thin_(thin),
        steps_left_(query.budget.max_steps > 0 ? query.budget.max_steps : kUnlimited) {
    squeezed_.fail(Outcome::depth_limit);  // as long as there is no walk, or nothing is left for it
    limits_.deadline = query.budget.timeout > 0 ? Deadline::after_seconds(query.budget.timeout) : Deadline();
    limits_.steps_left = query.budget.max_steps > 0 ? &steps_left_ : nullptr;
    limits_.pause_after = static_cast<std::uint64_t>(parameters.forest_after);
  }

  /// `between`: states that are given pushes.
  void push_and_walk(const std::function<void()>& between = {}) {
    const unsigned depth = query_.budget.max_depth;
    const PathQuery to_push = from(query_, &Reached::pushed);
    pushes_ = run_to_end(*push::start(to_push, tactics_, context_, between));
    spend(pushes_.stats.steps + pushes_.stats.state_checks);
    if (!undecided(pushes_)) return;
    // Ways that the judge refused lead out, and only cut a little too deep.
    const bool nearly = pushes_.outcome() == Outcome::exhausted && pushes_.stats.refused > 0;
    if (!nearly && depth < kLeastDepth) return;
    const unsigned halvings = nearly ? 0 : kDeepSearch - std::min(depth, kDeepSearch);
    walk(std::ldexp(static_cast<double>(parameters_.squeeze_looks), -static_cast<int>(halvings)));
  }

  PathResult pushed_or_walked() const {
    return together(undecided(pushes_) && !undecided(squeezed_) ? squeezed_ : pushes_);
  }

  static constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();
  static constexpr unsigned kDeepSearch = 8;  // that deep and deeper: a whole walk
  static constexpr unsigned kMostDetours = 8;
  static constexpr std::int64_t kFewRefusals = 3;
  static constexpr std::uint64_t kLeadThinAfter = 10;  // of what is thin pushes pause for walks so many times earlier

  /// The same query, to go on from what one of them had reached.
  static PathQuery from(const PathQuery& query, Reached::One Reached::*one) {
    PathQuery own = query;
    const auto* all = dynamic_cast<const Reached*>(query.resume_from);
    own.resume_from = all != nullptr ? (all->*one).get() : nullptr;
    return own;
  }

  void spend(std::uint64_t steps) {
    if (limits_.steps_left != nullptr) steps_left_ -= std::min(steps_left_, steps);
  }

  /// Looks count as steps.
  void walk(double looks) {
    const std::uint64_t most = std::min(static_cast<std::uint64_t>(looks), steps_left_);
    if (most > 0) {
      const PathQuery query = from(query_, &Reached::squeezed);
      tolerant_walk::Walk walk(tolerant_walk::Parameters{}, query, context_, cache_, most);
      squeezed_ = run_to_end(walk);
      spend(walk.looks());
    }
    if (undecided(squeezed_) && steps_left_ == 0) squeezed_.fail(Outcome::timeout);
  }

  /// Likewise. Patience and detours halved so many times.
  void lead(const PathQuery& query, unsigned halvings) {
    const double patience = std::ldexp(static_cast<double>(parameters_.lead_looks), -static_cast<int>(halvings));
    const unsigned detours = kMostDetours >> halvings;
    led_.fail(Outcome::depth_limit);
    if (patience > 0 && steps_left_ > 0) {
      tolerant_walk::Parameters walk;
      if (thin_) {
        // What has only some play so may be held with interference all the way out. Else its ways lead through walls.
        if (lead(query, tolerant_walk::Overlap::near_start, walk, patience, detours)) {
          walk.max_refusals = kFewRefusals;
          lead(query, tolerant_walk::Overlap::everywhere, walk, patience, detours);
        }
      } else {
        lead(query, tolerant_walk::Overlap::everywhere, walk, patience, detours);
      }
    }
    if (undecided(led_) && steps_left_ == 0) led_.fail(Outcome::timeout);
  }

  /// True where that shows no more than some play.
  bool lead(const PathQuery& query, tolerant_walk::Overlap overlap, const tolerant_walk::Parameters& parameters,
            double patience, unsigned most_detours) {
    const bool only_near_start = overlap == tolerant_walk::Overlap::near_start;
    const PathQuery own = from(query, only_near_start ? &Reached::led_thin : &Reached::led);
    free_space::LedWalk walk(parameters, own, context_,
                             {static_cast<std::size_t>(parameters_.lead_cells), patience, most_detours}, overlap,
                             cache_);
    if (walk.leads_out() && steps_left_ > 0) {
      walk.run({.max_steps = steps_left_});
      led_ = walk.result();
      (only_near_start ? led_thin_reached_ : led_reached_) = led_.state;
    }
    spend(walk.looks());
    return undecided(led_) && walk.held();
  }

  /// What all have counted and touched, in the one that says how it ended.
  PathResult together(PathResult end) const {
    SearchStats all = pushes_.stats;
    const std::pair<const char*, const PathResult*> others[] = {
        {"led_", &led_}, {"squeeze_", &squeezed_}, {"forest_", &forest_}};
    for (const auto& [prefix, other] : others) {
      SearchStats part = other->stats;
      const std::map<std::string, double> named = part.by_name();
      part.extra.clear();
      all += part;
      for (const auto& [name, value] : named) all.extra[prefix + name] = value;
    }
    end.stats = std::move(all);
    for (const auto* other : {&pushes_, &led_, &squeezed_, &forest_})
      for (const PartId part : other->blocked_by)
        if (std::find(end.blocked_by.begin(), end.blocked_by.end(), part) == end.blocked_by.end())
          end.blocked_by.push_back(part);
    if (end.message.empty() && !is_success(end.outcome())) end.message = pushes_.message;
    if (is_success(end.outcome())) return end;
    auto reached = std::make_shared<Reached>();
    reached->pushed = pushes_.state;
    reached->led = led_reached_;
    reached->led_thin = led_thin_reached_;
    reached->squeezed = squeezed_.state;
    end.state = std::move(reached);
    return end;
  }

  const PathQuery& query_;
  const Parameters& parameters_;
  const push::Tactics& tactics_;
  tolerant_walk::GeometryCache& cache_;
  RunContext& context_;
  const bool thin_;
  std::uint64_t steps_left_;
  push::Search::Limits limits_;
  PathResult pushes_, led_, squeezed_, forest_;
  Reached::One led_reached_, led_thin_reached_;
};

}  // namespace

PathResult plan_with_others(const PathQuery& query, const Parameters& parameters, const push::Tactics& tactics,
                            tolerant_walk::GeometryCache& cache, RunContext& context) {
  Others others(query, parameters, tactics, cache, context);
  return query.budget.max_depth > 0 ? others.under_depth_limit() : others.by_turns();
}

}  // namespace dismantle::guided
