#include "blocking/run.h"

#include <utility>

#include "blocking/strategies/pair_search.h"
#include "blocking/strategies/partial_translation.h"
#include "blocking/strategies/path_search.h"
#include "blocking/strategies/postponed_search.h"
#include "blocking/strategies/repeated_path.h"
#include "blocking/strategies/rotation_in_place.h"
#include "blocking/strategies/simultaneous_motion.h"
#include "blocking/strategies/target_first.h"
#include "blocking_graph/strategies/free_group.h"
#include "blocking_graph/strategies/free_part.h"
#include "blocking_graph/strategies/highest_first.h"

namespace dismantle::blocking {

Run::Run(const BlockingParameters& params, const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
         RunContext& context)
    : params_(params),
      oracle_(oracle),
      state_(query, overlap_locks(query, oracle, context), params.order, observer, context),
      history_(state_, params),
      stated_(query.assembly),
      relaxation_(state_, oracle, params.snap_depth_of_few),
      list_(state_, oracle) {
  const Assembly& assembly = query.assembly;
  state_.add_listener(history_);
  if (oracle.tolerance() > 0) sweep_ = std::make_unique<PairSweep>(assembly, oracle);
  if (sweep_ && params.straight) {
    straight_ = std::make_unique<StraightMotion>(state_, oracle, *sweep_, directions_of(assembly));
    state_.add_listener(*straight_);
  }
  lookahead_ = std::make_unique<Lookahead>(state_, history_, oracle);
  snaps_ = std::make_unique<SnapFits>(state_, oracle, straight_.get(), relaxation_, params, !query.said.empty());
  searcher_ = std::make_unique<PathSearcher>(state_, history_, *lookahead_, oracle, straight_.get(), *snaps_);
  make_strategies();
}

/// The cheapest and most conclusive strategies come first.
void Run::make_strategies() {
  if (straight_) {
    list_.add(std::make_unique<TargetFirst>(state_, *straight_));
    if (params_.upwards == Upwards::on) {
      for (const DirectionFilter filter : {DirectionFilter::up, DirectionFilter::not_down})
        if (!stated_.empty()) list_.add(std::make_unique<HighestFirst>(state_, *straight_, stated_, filter));
      list_.add(std::make_unique<FreePart>(state_, *straight_, DirectionFilter::up));
      list_.add(std::make_unique<FreePart>(state_, *straight_, DirectionFilter::not_down));
      if (params_.groups)
        list_.add(std::make_unique<FreeGroup>(state_, *straight_, params_.group_proposals, DirectionFilter::not_down));
    }
    list_.add(std::make_unique<FreePart>(state_, *straight_));
    if (params_.groups) list_.add(std::make_unique<FreeGroup>(state_, *straight_, params_.group_proposals));
  }
  if (params_.repeated_paths && sweep_) list_.add(std::make_unique<RepeatedPath>(state_, oracle_, *sweep_, params_));
  if (params_.translation_states > 0 && sweep_)
    list_.add(std::make_unique<PartialTranslation>(state_, oracle_, *sweep_, straight_.get(), *snaps_, params_));
  if (straight_ && params_.rotations)
    list_.add(std::make_unique<RotationInPlace>(state_, oracle_, *straight_, *sweep_, params_));
  if (straight_ && params_.simultaneous)
    list_.add(std::make_unique<SimultaneousMotion>(state_, oracle_, *straight_, *lookahead_, history_, *snaps_,
                                                   relaxation_, params_, params_.max_depth,
                                                   params_.play * oracle_.tolerance()));
  list_.add(std::make_unique<PathSearch>(state_, history_, *searcher_, params_));
  list_.add(std::make_unique<PairSearch>(state_, history_, *searcher_, *lookahead_, *snaps_, params_));
  list_.add(std::make_unique<PostponedSearch>(state_, history_, *searcher_, params_));
}

SequenceResult Run::run() {
  SequenceResult result = list_.run();
  if (straight_) result.counts["relations"] = static_cast<double>(straight_->computed());
  return result;
}

}  // namespace dismantle::blocking
