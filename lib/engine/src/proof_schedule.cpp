#include "proof_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include "dismantle/executor.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/solid.h"
#include "snap_depth.h"

namespace dismantle {
namespace {

using Clock = std::chrono::steady_clock;

bool has_part(const std::vector<PlacedPart>& group, PartId part) {
  return std::any_of(group.begin(), group.end(), [part](const PlacedPart& p) { return p.part == part; });
}

bool as_deep(const Attempt& attempt, unsigned depth) { return attempt.max_depth == 0 || attempt.max_depth >= depth; }

bool is_pair(const Attempt& attempt) { return attempt.moving.size() == 1 && attempt.fixed.size() == 1; }

// From this depth on, a search for a path of one part among several costs more than proofs of low effort about a few
// pairs.
constexpr unsigned kDepthOfHolders = 2;
constexpr std::size_t kMostHolders = 2;
constexpr double kShareOfHolders = 0.125;  // of the steps before other proofs: two proofs of low effort, known by pair
constexpr double kSmallSnap = 4;           // tolerances
// Multiples of the tolerance that a proof is first tried for. It says more, and its cells are larger, so it is found
// sooner: what holds two parts is as large as the parts are, however fine the tolerance is.
constexpr double kCoarse[] = {100, 10};

bool found_nothing(Outcome o) { return o == Outcome::depth_limit || o == Outcome::exhausted || o == Outcome::timeout; }

}  // namespace

PathResult infeasible_by(const Certificate& certificate, const Attempt& attempt) {
  PathResult result = PathResult::failure(Outcome::infeasible, certificate.text);
  for (const PartId id : certificate.parts)
    if (has_part(attempt.fixed, id)) result.blocked_by.push_back(id);
  return result;
}

ProofSchedule::ProofSchedule(const Assembly& assembly, const Verifier& verifier, std::vector<NamedProver> provers,
                             const ProofOptions& options, const RunContext& context)
    : assembly_(assembly), verifier_(verifier), tolerance_(verifier.options().max_penetration), options_(options) {
  for (NamedProver& named : provers) {
    const ProverTraits traits = named.prover->traits();
    provers_.push_back({std::move(named), traits});
  }
  for (const Part& part : assembly.parts) {  // shared with the verifier, which outlives the memo
    memo_.put("solids", part.id,
              std::shared_ptr<const std::vector<geometry::Solid>>(std::shared_ptr<void>(), &verifier.solids(part.id)));
    memo_.put("hull", part.id,
              std::shared_ptr<const std::vector<Eigen::Vector3d>>(std::shared_ptr<void>(), &verifier.hull(part.id)));
  }
  if (provers_.empty()) return;
  std::vector<const Certificate*> found(assembly.overlaps.size());
  parallel_for(
      found.size(), context,
      [&](std::size_t i) {
        found[i] = prove({{assembly.overlaps[i].a, assembly.overlaps[i].b}, ProofEffort::trivial, 1}, context);
      },
      [] { return false; });
  std::copy_if(found.begin(), found.end(), std::back_inserter(locks_),
               [](const Certificate* c) { return c != nullptr; });
}

bool ProofSchedule::asks(const Prover& prover, ProofEffort effort, bool depends_on_poses, std::size_t parts) const {
  const ProverTraits& t = prover.traits;
  return t.effort == effort && t.depends_on_poses == depends_on_poses && parts >= t.min_parts && parts <= t.max_parts;
}

/// Empty when stopped.
std::optional<ProofSchedule::Answer> ProofSchedule::ask(const SeparationQuery& query, ProofEffort effort,
                                                        bool depends_on_poses, const RunContext& context) {
  const Clock::time_point begin = Clock::now();
  Answer answer;
  RunContext own = context;
  if (const double left = context.deadline.seconds_left(); effort == ProofEffort::high && std::isfinite(left))
    own.deadline = Deadline::after_seconds(options_.deadline_share * left);
  for (const Prover& prover : provers_) {
    if (!asks(prover, effort, depends_on_poses, query.moving.size() + query.fixed.size())) continue;
    const Clock::time_point began = Clock::now();
    try {
      answer = prover.named.prover->prove(query, own);
    } catch (const std::exception& e) {
      answer.reset();
      context.log(LogLevel::error, fmt::format("immobility prover '{}' threw: {}", prover.named.id, e.what()));
    } catch (...) {
      answer.reset();
      context.log(LogLevel::error,
                  fmt::format("immobility prover '{}' threw something that is not a std::exception", prover.named.id));
    }
    context.log(
        LogLevel::debug,
        fmt::format("proof by '{}' about '{}' and {} more: {}, {:.4f} s", prover.named.id,
                    assembly_.parts[query.moving.front().part].name, query.moving.size() + query.fixed.size() - 1,
                    answer ? "proved" : "not proved", std::chrono::duration<double>(Clock::now() - began).count()));
    if (!answer) continue;
    answer->kind = prover.named.id;
    answer->margin = query.margin();
    answer->full_tolerance = query.share >= 1 - geometry::kRounding;
    break;
  }
  nanoseconds_ += static_cast<std::uint64_t>(std::chrono::nanoseconds(Clock::now() - begin).count());
  if (!answer && context.should_stop()) return std::nullopt;
  return answer;
}

const Certificate* ProofSchedule::prove(const SeparationQuestion& question, const RunContext& context) {
  SeparationQuestion key = question;
  std::sort(key.parts.begin(), key.parts.end());
  if (key.parts.size() < 2 || key.parts.back() >= assembly_.parts.size() || !(key.share > 0) || key.share > 1 ||
      std::adjacent_find(key.parts.begin(), key.parts.end()) != key.parts.end())
    throw std::invalid_argument("a question whether parts can be separated needs two distinct parts of the assembly");
  return answer_to(key, context);
}

const Certificate* ProofSchedule::answer_to(const SeparationQuestion& key, const RunContext& context) {
  if (std::none_of(provers_.begin(), provers_.end(),
                   [&](const Prover& p) { return asks(p, key.effort, false, key.parts.size()); }))
    return nullptr;
  ComputedOnce<Answer>* entry = nullptr;
  {
    const std::scoped_lock lock(mutex_);
    entry = &answers_[key];
  }
  SeparationQuery query{
      assembly_, {{key.parts.front(), Pose{}}}, {}, std::max(key.share, 1.0) * tolerance_, std::min(key.share, 1.0),
      memo_};
  for (std::size_t i = 1; i < key.parts.size(); ++i) query.fixed.push_back({key.parts[i], Pose{}});
  const Answer* answer = entry->get(context, [&] { return ask(query, key.effort, false, context); });
  return answer != nullptr && *answer ? &**answer : nullptr;
}

const Certificate* ProofSchedule::prove_placed(const Attempt& attempt, const RunContext& context) {
  const std::size_t parts = attempt.moving.size() + attempt.fixed.size();
  if (std::none_of(provers_.begin(), provers_.end(),
                   [&](const Prover& p) { return asks(p, ProofEffort::low, true, parts); }))
    return nullptr;
  ComputedOnce<Answer>* entry = nullptr;
  {
    const std::scoped_lock lock(mutex_);
    entry = &placed_answers_[digest_of(attempt)];
  }
  const SeparationQuery query{assembly_, attempt.moving, attempt.fixed, tolerance_, 1, memo_};
  const Answer* answer = entry->get(context, [&] { return ask(query, ProofEffort::low, true, context); });
  return answer != nullptr && *answer ? &**answer : nullptr;
}

const Certificate* ProofSchedule::locked(const Attempt& attempt) const {
  if (!attempt.goal.any_of.empty()) {
    const Certificate* found = nullptr;
    for (const PartId id : attempt.goal.any_of) {
      const auto here = [&](PartId other) { return has_part(attempt.moving, other) || has_part(attempt.fixed, other); };
      const auto lock = std::find_if(locks_.begin(), locks_.end(), [&](const Certificate* c) {
        return (c->parts[0] == id && here(c->parts[1])) || (c->parts[1] == id && here(c->parts[0]));
      });
      if (lock == locks_.end()) return nullptr;
      if (found == nullptr) found = *lock;
    }
    return found;
  }
  const auto lock = std::find_if(locks_.begin(), locks_.end(), [&](const Certificate* c) {
    return (has_part(attempt.moving, c->parts[0]) && has_part(attempt.fixed, c->parts[1])) ||
           (has_part(attempt.moving, c->parts[1]) && has_part(attempt.fixed, c->parts[0]));
  });
  return lock == locks_.end() ? nullptr : *lock;
}

const Certificate* ProofSchedule::before(const Attempt& attempt) const {
  return provers_.empty() || attempt.goal.placement ? nullptr : locked(attempt);
}

bool ProofSchedule::is_provable(const Attempt& attempt, unsigned depth) const {
  return !provers_.empty() && attempt.goal.any_of.empty() && !attempt.goal.placement && !attempt.fixed.empty() &&
         as_deep(attempt, depth);
}

std::vector<SearchPause> ProofSchedule::during(const Attempt& attempt, const RunContext& context) {
  std::vector<SearchPause> pauses;
  // A search for one part of a pair that has come so far has cost more than the proof, however deep it may go.
  const bool pair = is_pair(attempt);
  const bool low = is_provable(attempt, pair ? 0 : options_.low_effort_depth);
  const bool costly = pair && is_provable(attempt, 0);
  const auto soon = static_cast<std::uint64_t>(kShareOfHolders * static_cast<double>(options_.low_effort_steps));
  if (soon > 0 && is_holdable(attempt))
    pauses.push_back({soon, [this, &attempt, &context](const std::vector<PartId>& touched) {
                        return prove_held(attempt, touched, context);
                      }});
  if (low || is_holdable(attempt))
    pauses.push_back({static_cast<std::uint64_t>(options_.low_effort_steps),
                      [this, low, &attempt, &context](const std::vector<PartId>& touched) {
                        const Certificate* found = low ? prove_low(attempt, context) : nullptr;
                        return found != nullptr ? found : prove_held(attempt, touched, context);
                      }});
  if (costly && options_.medium_effort_steps > options_.low_effort_steps)
    pauses.push_back({static_cast<std::uint64_t>(options_.medium_effort_steps),
                      [this, &attempt, &context](const std::vector<PartId>&) {
                        return prove_pair(attempt.moving.front().part, attempt.fixed.front().part, ProofEffort::medium,
                                          context);
                      }});
  // The reduced tolerance tells whether there is hope; only a proof for the whole one ends a search.
  if (costly && options_.high_effort_steps > std::max(options_.low_effort_steps, options_.medium_effort_steps))
    pauses.push_back({static_cast<std::uint64_t>(options_.high_effort_steps),
                      [this, &attempt, &context](const std::vector<PartId>&) {
                        const Certificate* found =
                            prove_high(attempt.moving.front().part, attempt.fixed.front().part, context);
                        return found != nullptr && found->full_tolerance ? found : nullptr;
                      }});
  return pauses;
}

const Certificate* ProofSchedule::prove_low(const Attempt& attempt, const RunContext& context) {
  if (const Certificate* found = prove_placed(attempt, context)) return found;
  if (!is_pair(attempt)) return nullptr;
  return prove({{attempt.moving.front().part, attempt.fixed.front().part}, ProofEffort::low, 1}, context);
}

bool ProofSchedule::is_holdable(const Attempt& attempt) const {
  return attempt.moving.size() == 1 && attempt.fixed.size() > 1 && is_provable(attempt, kDepthOfHolders);
}

/// Is the part held by one of those that it touched most: a rivet by a plate, a pin with two heads by a hinge?
const Certificate* ProofSchedule::prove_held(const Attempt& attempt, const std::vector<PartId>& touched,
                                             const RunContext& context) {
  if (!is_holdable(attempt)) return nullptr;
  const PartId part = attempt.moving.front().part;
  for (std::size_t k = 0; k < std::min(touched.size(), kMostHolders); ++k)
    if (has_part(attempt.fixed, touched[k]))
      if (const Certificate* found = prove({{part, touched[k]}, ProofEffort::low, 1}, context)) return found;
  return nullptr;
}

const Certificate* ProofSchedule::prove_pair(PartId a, PartId b, ProofEffort most, const RunContext& context) {
  for (const ProofEffort effort : {ProofEffort::low, ProofEffort::medium, ProofEffort::high}) {
    if (effort > most) break;
    if (const Certificate* found = prove({{a, b}, effort, 1}, context)) return found;
  }
  return nullptr;
}

/// Asked again for the same pair by each search for one of its parts.
double ProofSchedule::cut_of(PartId a, PartId b, const RunContext& context) {
  ComputedOnce<double>* entry = nullptr;
  {
    const std::scoped_lock lock(mutex_);
    entry = &cuts_[std::minmax(a, b)];
  }
  const double* cut = entry->get(context, [&]() -> std::optional<double> {
    const double found = straight_cut(assembly_, verifier_, std::min(a, b), std::max(a, b),
                                      kSmallSnap * kCoarse[0] * tolerance_, context);
    return context.should_stop() ? std::nullopt : std::optional(found);
  });
  return cut == nullptr ? std::numeric_limits<double>::infinity() : *cut;
}

/// Null also for pairs that a straight motion nearly parts: snap fits, and thin walls, which the verifier lets nothing
/// through. The cells of a proof of high effort are far smaller than what holds the parts beyond the tolerance:
/// for a snap of a few tolerances it takes long and fails, and for less than the tolerance it must fail.
const Certificate* ProofSchedule::prove_reduced(PartId a, PartId b, const RunContext& context) {
  const double cut = cut_of(a, b, context);
  const auto is_snap = [&](double share) { return cut <= kSmallSnap * share * tolerance_; };
  bool tried = false;
  for (const double share : kCoarse) {
    if (is_snap(share)) continue;
    tried = true;
    if (const Certificate* found = answer_to({{std::min(a, b), std::max(a, b)}, ProofEffort::high, share}, context))
      return found;
  }
  // What is not proved although the parts hold each other far deeper takes more cells than there may be, and finer
  // ones are no fewer.
  if (tried || (cut >= 0 && is_snap(1))) return nullptr;
  return prove({{a, b}, ProofEffort::high, options_.reduced_tolerance}, context);
}

const Certificate* ProofSchedule::prove_high(PartId a, PartId b, const RunContext& context) {
  const Certificate* found = prove_reduced(a, b, context);
  if (found == nullptr || found->full_tolerance) return found;
  const Certificate* whole = prove_pair(a, b, ProofEffort::high, context);
  return whole != nullptr ? whole : found;
}

/// Tries expensive proofs only for pairs. Larger sets wait until the sequence planner asks or the run ends, because
/// most of their parts can leave once others have left.
const Certificate* ProofSchedule::after(const Attempt& attempt, const PathResult& result, const RunContext& context) {
  if (!found_nothing(result.outcome())) return nullptr;
  if (const Certificate* found = prove_held(attempt, result.blocked_by, context)) return found;
  // No deeper search follows one that ended before the limit of its depth, by its budget, too.
  const bool ended = is_pair(attempt) && result.outcome() != Outcome::depth_limit;
  if (!is_provable(attempt, ended ? 0 : options_.low_effort_depth)) return nullptr;
  if (const Certificate* found = prove_low(attempt, context)) return found;
  if (!is_pair(attempt) || !is_provable(attempt, ended ? 0 : options_.medium_effort_depth)) return nullptr;
  const PartId a = attempt.moving.front().part, b = attempt.fixed.front().part;
  if (const Certificate* found = prove_pair(a, b, ProofEffort::medium, context)) return found;
  // A proof of high effort costs most for pairs that can be separated; a deeper search may still find a path.
  return ended || attempt.max_depth == 0 ? prove_reduced(a, b, context) : nullptr;
}

const Certificate* ProofSchedule::at_last(PartId part, const std::vector<PartId>& blocked_by,
                                          const std::vector<PartId>& group, const RunContext& context) {
  if (provers_.empty() || group.size() < 2) return nullptr;
  std::optional<PartId> holder;
  if (group.size() == 2)
    holder = group.front() == part ? group.back() : group.front();
  else if (blocked_by.size() == 1)
    holder = blocked_by.front();
  if (holder && *holder != part) {
    if (const Certificate* found = prove_pair(part, *holder, ProofEffort::medium, context)) return found;
    if (const Certificate* found = prove_high(part, *holder, context)) return found;
  }
  return group.size() > 2 ? prove({group, ProofEffort::high, options_.reduced_tolerance}, context) : nullptr;
}

}  // namespace dismantle
