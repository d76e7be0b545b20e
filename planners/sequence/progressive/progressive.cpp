#include "progressive/progressive.h"

#include <span>
#include <vector>

namespace dismantle {

void ProgressiveParameters::describe(Schema<ProgressiveParameters>& schema) {
  schema.add_choice("order", &ProgressiveParameters::order, part_orders(),
                    "Order in which the parts left are tried within a round.");
  schema.add("max_depth", &ProgressiveParameters::max_depth,
             {.unit = "1",
              .min = 0,
              .max = 1e6,
              .doc = "Largest depth of the path search; 0 = no limit: rounds continue until more depth cannot help."});
  schema.add("deepen_always", &ProgressiveParameters::deepen_always,
             {.doc = "Go deeper with every round, as Algorithm 2 does. Off: only after a round in which no part left, "
                     "since most parts leave by a simple motion once their blockers have left."});
  schema.add("last_pair_unlimited", &ProgressiveParameters::last_pair_unlimited,
             {.doc = "When two parts are left and max_depth is 0, their searches have no depth limit, because no other "
                     "part could be tried instead. Off: exactly Algorithm 2."});
}

SequenceResult Progressive::plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                                 RunContext& context) {
  Preference preference(query);
  return each_group(query, [&](const std::vector<PlacedPart>& group) {
    OneByOne sequence(query.assembly, ordered_group(query.assembly, group, params_.order), oracle, observer, context);
    for (unsigned depth = 1; !sequence.done(); ++depth) {
      bool removed_any = false;
      bool deeper_may_help = false;
      const std::vector<PartId> round = sequence.left();
      const bool choose = preference.active() && round.size() > 2;
      if (choose)
        for (const Outcome outcome : sequence.attempt_each(round, depth, preference)) {
          removed_any = removed_any || is_success(outcome);
          deeper_may_help = deeper_may_help || outcome == Outcome::depth_limit;
        }
      for (std::size_t i = 0; !choose && i < round.size() && !sequence.done(); ++i) {
        if (sequence.interrupted()) return sequence.finish();
        if (params_.last_pair_unlimited && params_.max_depth == 0 && sequence.left().size() == 2) {
          for (const PartId part : std::vector<PartId>(sequence.left()))
            if (!sequence.done() && !sequence.interrupted()) sequence.attempt(part, 0);
          return sequence.finish();
        }
        const Outcome outcome = sequence.attempt(round[i], depth, std::span(round).subspan(i + 1));
        removed_any = removed_any || is_success(outcome);
        deeper_may_help = deeper_may_help || outcome == Outcome::depth_limit;
      }
      if (sequence.interrupted()) break;
      const bool at_limit = params_.max_depth != 0 && depth >= params_.max_depth;
      // At the limit a round is repeated at the same depth, as long as parts leave, because this may free others.
      if (removed_any && (at_limit || !params_.deepen_always)) --depth;
      if (!removed_any && (at_limit || !deeper_may_help)) break;
    }
    return sequence.finish();
  });
}

}  // namespace dismantle
