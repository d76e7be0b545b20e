// Key functions of the interfaces: their type information lives here once, so that a plugin's object is
// recognised across shared libraries.
#include <stdexcept>

#include "dismantle/importer.h"
#include "dismantle/path_oracle.h"
#include "dismantle/sequence_planner.h"
#include "dismantle/simulator.h"
#include "dismantle/transfer_planner.h"

namespace dismantle {

World::~World() = default;
bool World::body_separated(const State& state, std::size_t body) {
  if (scene().moving.size() != 1 || body != 0)
    throw std::logic_error("a simulator that moves several parts simultaneously has to override World::body_separated");
  return separated(state);
}
PreparedAssembly::~PreparedAssembly() = default;
Simulator::~Simulator() = default;

PathOracle::~PathOracle() = default;
const Certificate* PathOracle::prove(const SeparationQuestion& /*question*/, const RunContext& /*context*/) {
  return nullptr;
}
const Constraints& PathOracle::constraints() const {
  static const Constraints none;
  return none;
}
TransferPlanner::~TransferPlanner() = default;
SequenceObserver::~SequenceObserver() = default;
SequencePlanner::~SequencePlanner() = default;
Importer::~Importer() = default;

}  // namespace dismantle
