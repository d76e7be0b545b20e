#include "state_based/state_based.h"

#include <memory>
#include <utility>

#include "blocking_graph/strategies/free_group.h"
#include "blocking_graph/strategies/free_part.h"
#include "blocking_graph/strategies/search_rounds.h"
#include "blocking_graph/strategy_list.h"
#include "state_based/evaluation.h"
#include "state_based/translate_out.h"

namespace dismantle {

void StateBasedParameters::describe(Schema<StateBasedParameters>& s) {
  s.add_choice("order", &StateBasedParameters::order, part_orders(),
               "Order in which translations are tried, and searches of parts with equal evaluation.");
  s.add_choice("evaluation", &StateBasedParameters::evaluation,
               {{"fewest_blockers", StateBasedEvaluation::fewest_blockers,
                 "the part that the fewest others block, from any state that it has reached"},
                {"most_useful", StateBasedEvaluation::most_useful, "the part that blocks the most others"}},
               "Which part is searched for first when no translation removes one.");
  s.add("states", &StateBasedParameters::states,
        {.unit = "1",
         .min = 1,
         .max = 1e5,
         .doc = "Largest number of motion states of one part. Paths of many short translations need more; time grows "
                "in proportion."});
  s.advanced("stops", &StateBasedParameters::stops, {1, 100});
  s.advanced("halvings", &StateBasedParameters::halvings, {1, 50});
  s.advanced("retreat", &StateBasedParameters::retreat, {0, 1e6});
  s.advanced("least_step", &StateBasedParameters::least_step, {.min = 0, .max = 1, .min_open = true});
  s.add("groups", &StateBasedParameters::groups,
        {.doc = "When no single part is free, remove the smallest free group."});
  s.advanced("group_proposals", &StateBasedParameters::group_proposals, {1});
  s.add("searches", &StateBasedParameters::searches,
        {.doc = "When translations remove nothing, run the path planner for each part, one level deeper in every "
                "round. Only these searches find rotations."});
  s.add("resume", &StateBasedParameters::resume,
        {.doc = "A search by the path planner resumes the last one of the same part."});
  s.add("max_depth", &StateBasedParameters::max_depth,
        {.unit = "1", .min = 0, .max = 1e6, .doc = "Largest depth of the searches; 0 = no limit."});
}

SequenceResult StateBased::plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                                RunContext& context) {
  using namespace blocking;
  const Assembly& assembly = query.assembly;
  DisassemblyState state(query, overlap_locks(query, oracle, context), params_.order, observer, context);
  StrategyList list(state, oracle);
  std::unique_ptr<PairSweep> sweep;
  std::unique_ptr<StraightMotion> straight;
  std::unique_ptr<state_based::MotionStates> states;
  SearchRounds::Order order;
  if (oracle.tolerance() > 0) {
    sweep = std::make_unique<PairSweep>(assembly, oracle);
    straight = std::make_unique<StraightMotion>(state, oracle, *sweep, directions_of(assembly));
    states = std::make_unique<state_based::MotionStates>(
        state, *straight, *sweep, oracle.tolerance(),
        state_based::MotionStateParameters{params_.states, params_.stops, params_.halvings, params_.retreat,
                                           params_.least_step});
    state.add_listener(*straight);
    list.add(std::make_unique<FreePart>(state, *straight));
    list.add(std::make_unique<state_based::TranslateOut>(state, *states, oracle));
    if (params_.groups) list.add(std::make_unique<FreeGroup>(state, *straight, params_.group_proposals));
    order = [&](const GroupState& group, const Subassemblies& ids) {
      return state_based::by_evaluation(state, *states, group, ids, params_.evaluation);
    };
  }
  // An oracle without geometry allows no sweeps, so only searches are left.
  if (params_.searches || !straight)
    list.add(std::make_unique<SearchRounds>(state, oracle, SearchRounds::Settings{params_.max_depth, params_.resume},
                                            std::move(order)));
  SequenceResult result = list.run();
  if (straight) {
    result.counts["relations"] = static_cast<double>(straight->computed());
    result.counts["states"] = static_cast<double>(states->states());
    result.counts["kept"] = static_cast<double>(states->kept());
  }
  return result;
}

}  // namespace dismantle
