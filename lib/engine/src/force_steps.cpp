#include "force_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "group_oracle.h"
#include "stopwatch.h"

namespace dismantle {

namespace {

constexpr double kCoarse = 8;         // resolution of the first measurement, in tolerances
constexpr double kCoarseShare = 0.1;  // or this share of the depth
constexpr std::uint64_t kCoarsePoses = 200;
constexpr double kFineShare = 0.03;  // of the depth, in the statement
constexpr std::uint64_t kFinePoses = 400;
constexpr std::size_t kFinalists = 4;            // measured again, more exactly
constexpr double kAlike = 0.9;                   // cosine: directions of one set of parts differ by 25 degrees
constexpr std::size_t kOfOneSet = 4;             // motions of the same parts that are measured, at least
constexpr double kShareOfPlanning = 0.5;         // of the time that is left, for verified steps between forced ones
constexpr std::uint64_t kStream = 0x666f726365;  // "force"

/// Passes removals of a group on as removals of the whole.
class GroupObserver final : public SequenceObserver {
 public:
  GroupObserver(const GroupOracle& oracle, SequenceObserver& whole) : oracle_(oracle), whole_(whole) {}
  void removed(const Removal& removal, std::size_t parts_left) override {
    whole_.removed(oracle_.in_whole(removal), parts_left);
  }

 private:
  const GroupOracle& oracle_;
  SequenceObserver& whole_;
};

}  // namespace

ForceSteps::ForceSteps(const Assembly& assembly, const Verifier& verifier, Oracle& oracle, PlanBuilder& builder,
                       SequencePlanner& planner, SequenceObserver& observer, const RunOptions& options)
    : assembly_(assembly),
      verifier_(verifier),
      oracle_(oracle),
      builder_(builder),
      planner_(planner),
      observer_(observer),
      options_(options),
      motions_(assembly, verifier, options.constraints, options.force),
      normalizer_(assembly) {}

/// The motions to measure: of each set of parts the most promising ones, in directions that differ.
std::vector<const ForcedMotion*> ForceSteps::chosen(const std::vector<ForcedMotion>& all) const {
  std::map<std::vector<PartId>, std::vector<const ForcedMotion*>> of_set;
  for (const ForcedMotion& m : all) of_set.try_emplace(ids_of_placed(m.moving));
  const std::size_t most = std::max(kOfOneSet, options_.force.candidates / of_set.size());
  std::vector<const ForcedMotion*> list;
  for (const ForcedMotion& m : all) {
    std::vector<const ForcedMotion*>& same = of_set[ids_of_placed(m.moving)];
    const auto alike = [&](const ForcedMotion* other) {
      return m.straight() && other->straight() && m.twist.linear.dot(other->twist.linear) > kAlike;
    };
    if (same.size() >= most || std::any_of(same.begin(), same.end(), alike)) continue;
    same.push_back(&m);
    list.push_back(&m);
    if (list.size() == options_.force.candidates) break;
  }
  return list;
}

/// The motion that cuts in least: all roughly, then those that may be the best. Null when told to stop.
const ForcedMotion* ForceSteps::best_of(const std::vector<const ForcedMotion*>& list, const RunContext& context) {
  const double tolerance = verifier_.options().max_penetration;
  MotionDepthOptions options{kCoarse * tolerance, kCoarseShare, std::numeric_limits<double>::infinity(), kCoarsePoses};
  const auto unsure = [&](double excess) { return excess + std::max(options.absolute, options.relative * excess); };
  std::vector<std::pair<double, const ForcedMotion*>> measured;
  double least = std::numeric_limits<double>::infinity();
  for (const ForcedMotion* m : list) {
    const auto found = motions_.depth(*m, options, context);
    if (context.should_stop()) return nullptr;
    measured.emplace_back(found ? found->excess() : 0, m);
    least = std::min(least, measured.back().first);
    options.stop_above = unsure(least);
  }
  std::stable_sort(measured.begin(), measured.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const double worth_a_look = unsure(least);
  options = {2 * tolerance, kFineShare, std::numeric_limits<double>::infinity(), kFinePoses};
  const ForcedMotion* best = nullptr;
  for (std::size_t k = 0; k < measured.size() && k < kFinalists && measured[k].first <= worth_a_look; ++k) {
    const auto found = motions_.depth(*measured[k].second, options, context);
    if (context.should_stop()) return nullptr;
    const double excess = found ? found->excess() : 0;
    if (best != nullptr && excess >= options.stop_above) continue;
    best = measured[k].second;
    options.stop_above = excess;
    if (excess <= tolerance) break;
  }
  return best;
}

bool ForceSteps::force_one(const RunContext& context) {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<ForcedMotion> all;
  for (const Placed& group : builder_.open_groups())
    for (ForcedMotion& m : motions_.candidates(group, context)) all.push_back(std::move(m));
  if (all.empty() || context.should_stop()) return false;
  std::stable_sort(all.begin(), all.end(),
                   [](const ForcedMotion& a, const ForcedMotion& b) { return a.thickness < b.thickness; });
  const ForcedMotion* best = best_of(chosen(all), context);
  if (best == nullptr) return false;
  NormalizedPath written = normalizer_.normalize(motions_.path(*best), best->moving);
  if (!written.problem.empty()) throw std::logic_error("a forced path is unusable: " + written.problem);
  const auto worst = motions_.depth(*best, written.path, {verifier_.options().max_penetration, kFineShare}, context);
  if (context.should_stop()) return false;  // nothing is stated that was not measured to its end
  const std::vector<PartId> parts = ids_of_placed(best->moving);
  const MotionDepth stated = worst.value_or(MotionDepth{parts.front(), best->fixed.front().part});
  context.log(LogLevel::info,
              fmt::format("forced: '{}' past '{}', {:.4g} deep", assembly_.parts[stated.part].name,
                          assembly_.parts[stated.other].name, stated.depth / assembly_.normalization.scale));
  builder_.force(parts, written.path, stated, seconds_since(begin));
  return true;
}

/// Verified removals from the groups that are left, by the sequence planner, in searches of little depth.
void ForceSteps::take_apart(RunContext& context) {
  RunContext own = context;
  if (const double left = context.deadline.seconds_left(); std::isfinite(left))
    own.deadline = context.deadline.earlier(Deadline::after_seconds(kShareOfPlanning * left));
  for (const Placed& group : builder_.open_groups()) {
    if (own.should_stop()) return;
    if (!tried_.insert(ids_of_placed(group)).second) continue;
    GroupOracle oracle(assembly_, oracle_, group, options_.force.retry_depth);
    GroupObserver observer(oracle, observer_);
    own.rng = Rng(options_.seed).fork(kStream);
    try {
      planner_.plan(oracle.assembly(), oracle, observer, own);
    } catch (const std::exception& e) {
      context.log(LogLevel::error, fmt::format("the sequence planner failed on what was left: {}", e.what()));
    }
  }
}

void ForceSteps::run(bool unfinished, RunContext& context) {
  if (unfinished)
    take_apart(context);
  else
    for (const Placed& group : builder_.open_groups()) tried_.insert(ids_of_placed(group));
  while (!context.should_stop() && !builder_.fulfilled() && force_one(context)) take_apart(context);
}

}  // namespace dismantle
