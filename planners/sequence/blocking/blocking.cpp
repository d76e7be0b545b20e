#include "blocking/blocking.h"

#include "blocking/disassembly.h"

namespace dismantle {

SequenceResult Blocking::plan(const Assembly& assembly, PathOracle& oracle, SequenceObserver& observer,
                              RunContext& context) {
  return blocking::Disassembly(params_, assembly, oracle, observer, context).run();
}

}  // namespace dismantle
