#include "blocking/blocking.h"

#include "blocking/run.h"

namespace dismantle {

SequenceResult Blocking::plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                              RunContext& context) {
  return blocking::Run(params_, query, oracle, observer, context).run();
}

}  // namespace dismantle
