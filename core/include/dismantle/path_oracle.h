/// All that a sequence planner sees of geometry and physics.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/path_planner.h"

namespace dismantle {

/// "Can these parts leave together while those stay, with this effort?" All other parts are out.
struct Attempt {
  std::vector<PlacedPart> moving;
  std::vector<PlacedPart> still;
  unsigned max_depth = 0;  ///< 0 = no limit
};

/// An answer. `path` has passed the verifier.
struct AttemptResult {
  PathResult result;
  double max_penetration = 0;  ///< certified upper bound over the path, above the initial overlap; assembly units
  double seconds = 0;
};

struct OracleCounts {
  std::uint64_t attempts = 0;   ///< answered by planning
  std::uint64_t memoised = 0;   ///< answered from memory
  std::uint64_t discarded = 0;  ///< computed ahead, never asked for
};

/// Memoises, counts and verifies. May compute prefetched attempts on other threads; answers do not depend on it.
class DISMANTLE_API PathOracle {
 public:
  virtual ~PathOracle();
  /// Reference stays valid for the life of the oracle.
  virtual const AttemptResult& attempt(const Attempt& attempt, RunContext& context) = 0;
  /// Hint: these will probably be asked for, in this order. Replaces earlier hints that were not begun.
  virtual void prefetch(std::span<const Attempt> attempts, RunContext& context) = 0;
  virtual OracleCounts counts() const = 0;
};

}  // namespace dismantle
