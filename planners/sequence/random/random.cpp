#include "random/random.h"

#include <span>
#include <utility>
#include <vector>

#include "one_by_one/one_by_one.h"

namespace dismantle {

namespace {

void shuffle(std::vector<PartId>& parts, Rng& rng) {
  for (std::size_t n = parts.size(); n > 1; --n) std::swap(parts[n - 1], parts[rng.below(n)]);
}

}  // namespace

void RandomParameters::describe(Schema<RandomParameters>& schema) {
  schema.add("max_depth", &RandomParameters::max_depth,
             {.unit = "1", .min = 0, .max = 1e6, .doc = "Depth of the path search; 0 = no limit."});
}

SequenceResult Random::plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                            RunContext& context) {
  return each_group(query, [&](const std::vector<PlacedPart>& group) {
    OneByOne sequence(query.assembly, ordered_group(query.assembly, group, PartOrder::as_given), oracle, observer,
                      context);
    bool removed = true;
    while (removed && !sequence.done()) {  // a removal may free others: draw all again
      removed = false;
      std::vector<PartId> drawn = sequence.left();
      shuffle(drawn, context.rng);
      for (std::size_t i = 0; i < drawn.size() && !removed; ++i) {
        if (sequence.interrupted()) return sequence.finish();
        removed = is_success(sequence.attempt(drawn[i], params_.max_depth, std::span(drawn).subspan(i + 1)));
      }
    }
    sequence.interrupted();
    return sequence.finish();
  });
}

}  // namespace dismantle
