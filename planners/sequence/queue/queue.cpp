#include "queue/queue.h"

#include <vector>

namespace dismantle {

void QueueParameters::describe(Schema<QueueParameters>& schema) {
  schema.add_choice("order", &QueueParameters::order, part_orders(),
                    "Order in which the parts stand in the queue at the beginning.");
}

SequenceResult Queue::plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                           RunContext& context) {
  return each_group(query, [&](const std::vector<PlacedPart>& group) {
    OneByOne sequence(query.assembly, ordered_group(query.assembly, group, params_.order), oracle, observer, context);
    // The front and the back of the queue. `failed`: parts that were tried with exactly the parts that are left now.
    std::vector<PartId> waiting = sequence.left();
    std::vector<PartId> failed;
    while (!sequence.done() && !waiting.empty() && !sequence.interrupted()) {
      const PartId part = waiting.front();
      waiting.erase(waiting.begin());
      if (is_success(sequence.attempt(part, 0, waiting))) {
        waiting.insert(waiting.end(), failed.begin(), failed.end());  // the removal may have freed them: try all again
        failed.clear();
      } else {
        failed.push_back(part);
      }
    }
    sequence.interrupted();
    return sequence.finish();
  });
}

}  // namespace dismantle
