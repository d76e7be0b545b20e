#include "blocking/disassembly.h"

#include <utility>

#include "blocking/strategies/free_group.h"
#include "blocking/strategies/free_part.h"
#include "blocking/strategies/merge_immobile.h"
#include "blocking/strategies/pair_search.h"
#include "blocking/strategies/partial_translation.h"
#include "blocking/strategies/path_search.h"
#include "blocking/strategies/postponed_search.h"
#include "blocking/strategies/rotation_in_place.h"
#include "blocking/strategies/simultaneous_motion.h"
#include "blocking/strategies/target_first.h"

namespace dismantle::blocking {
namespace {

/// Parts whose overlap proves that no motion can separate them.
InseparablePairs overlap_locks(const Assembly& assembly, PathOracle& oracle, const RunContext& context) {
  InseparablePairs pairs;
  for (const InitialOverlap& overlap : assembly.overlaps)
    if (const Certificate* lock = oracle.prove({{overlap.a, overlap.b}, ProofEffort::trivial, 1}, context))
      pairs.emplace_back(lock->parts[0], lock->parts[1]);
  return pairs;
}

}  // namespace

Disassembly::Disassembly(const BlockingParams& params, const Assembly& assembly, PathOracle& oracle,
                         SequenceObserver& observer, RunContext& context)
    : params_(params),
      oracle_(oracle),
      state_(assembly, oracle.constraints(), overlap_locks(assembly, oracle, context), params.order, observer, context),
      history_(state_, params),
      report_(state_, oracle) {
  state_.add_listener(history_);
  if (oracle.tolerance() > 0) sweep_ = std::make_unique<PairSweep>(assembly, oracle);
  if (sweep_ && params.straight) {
    straight_ = std::make_unique<StraightMotion>(state_, oracle, *sweep_);
    state_.add_listener(*straight_);
    if (params.merge_immobile) immobility_ = std::make_unique<Immobility>(state_, *straight_, history_, oracle, params);
  }
  lookahead_ = std::make_unique<Lookahead>(state_, history_, oracle, immobility_.get(), straight_.get());
  if (immobility_)
    immobility_->before_proof = [this](const GroupState& group, const ImmobilityQuestion& question) {
      return lookahead_->before_proof(group, question);
    };
  searcher_ = std::make_unique<PathSearcher>(state_, history_, *lookahead_, oracle, straight_.get(), immobility_.get());
  make_strategies();
}

void Disassembly::add(std::unique_ptr<Strategy> strategy) {
  state_.add_listener(*strategy);
  strategies_.push_back(std::move(strategy));
}

/// What costs least and proves most comes first.
void Disassembly::make_strategies() {
  if (straight_) {
    add(std::make_unique<TargetFirst>(state_, *straight_));
    add(std::make_unique<FreePart>(state_, *straight_));
    if (params_.groups) add(std::make_unique<FreeGroup>(state_, *straight_, params_));
  }
  if (params_.translation_states > 0 && sweep_)
    add(std::make_unique<PartialTranslation>(state_, oracle_, straight_.get(), *lookahead_, params_));
  if (immobility_) add(std::make_unique<MergeImmobile>(*immobility_));
  if (straight_ && params_.rotations)
    add(std::make_unique<RotationInPlace>(state_, oracle_, *straight_, *sweep_, params_));
  if (straight_ && params_.simultaneous)
    add(std::make_unique<SimultaneousMotion>(state_, oracle_, *straight_, *lookahead_, params_, params_.max_depth));
  add(std::make_unique<PathSearch>(state_, history_, *searcher_, immobility_.get(), params_));
  add(std::make_unique<PairSearch>(state_, history_, *searcher_, *lookahead_, immobility_.get(), params_));
  add(std::make_unique<PostponedSearch>(state_, history_, *searcher_, params_));
  if (immobility_) add(std::make_unique<MergeImmobileLate>(*immobility_));
}

SequenceResult Disassembly::run() {
  while (!state_.waiting().empty()) {
    GroupState group = std::move(state_.waiting().front());
    state_.waiting().pop_front();
    take_apart(std::move(group));
  }
  if (!state_.target_removed()) report_.add_inseparable();
  SequenceResult result = report_.finish();
  if (straight_) result.counts["relations"] = static_cast<double>(straight_->computed());
  return result;
}

/// Tries one strategy after the other; after a change begins with the first again.
void Disassembly::take_apart(GroupState group) {
  for (std::size_t k = 0; k < strategies_.size() && group.members.size() > 1 && !state_.stop();) {
    switch (strategies_[k]->apply(group)) {
      case Result::unchanged:
        ++k;
        break;
      case Result::restart:
        k = 0;
        break;
      case Result::defer:
        state_.waiting().push_back(std::move(group));
        return;
    }
  }
  std::string notes;
  for (const auto& strategy : strategies_)
    if (const std::string note = strategy->failure_note(group); !note.empty())
      notes += (notes.empty() ? "" : "; ") + note;
  report_.add_left(group, notes);
}

}  // namespace dismantle::blocking
