/// Which forced step: compares motions by how deep they cut in, and by what is left to force after them.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "least_cut/forced_motions.h"

namespace dismantle::least_cut {

/// A motion and how deep it cuts in; `measured`: to the end.
struct Choice {
  ForcedMotion motion;
  std::optional<MotionDepth> depth{};
  bool measured = false;
  double excess() const { return depth ? depth->excess() : 0; }
};

/// Forced steps to the end: the sum of their depths, and how many they are.
struct Outlook {
  double depth = 0;
  std::size_t steps = 0;
  /// Less deep in sum; of sums within a tenth of the smaller one, the one of fewer steps.
  bool better_than(const Outlook& other) const;
};

class Comparison {
 public:
  /// All references must outlive it.
  Comparison(ForcedMotions& motions, const LeastCutParameters& params, double tolerance)
      : motions_(motions), params_(params), tolerance_(tolerance) {}

  /// The step of the groups with the best outlook. When stopped: the one that cuts in least of those compared so far,
  /// if any.
  std::optional<Choice> best(const std::vector<Placed>& groups, const RunContext& context);
  /// Of the motions that are tried, the least deep one each time, until no group is left. Empty when stopped or when it
  /// takes too many comparisons. `depths`: number of motions that may be compared, counted down.
  std::optional<Outlook> outlook(const Placed& group, std::size_t& depths, const RunContext& context);

 private:
  /// Which motions are compared to the end.
  struct Scope {
    double limit = 0;               ///< of each set of parts, the least below this; 0: the least of all
    std::size_t* depths = nullptr;  ///< counted down; ends at 0, or at the first motion that is free
  };
  std::vector<Choice> compared(const std::vector<Placed>& groups, const Scope& scope, const RunContext& context);
  std::vector<const ForcedMotion*> chosen(const std::vector<ForcedMotion>& all) const;
  bool alike(const ForcedMotion& a, const ForcedMotion& b) const;
  std::vector<std::pair<double, const ForcedMotion*>> not_shown_to_be_deeper(
      const std::vector<ForcedMotion>& all, const std::function<double(const ForcedMotion&)>& enough,
      const RunContext& context) const;
  std::optional<Outlook> outlook_after(const Choice& step, std::size_t& depths, const RunContext& context);
  Choice measured(Choice choice, double stop_above, const RunContext& context);
  std::vector<Choice> of_best_outlook(const std::vector<Choice>& list, std::size_t& depths, const RunContext& context);
  double unsure(double excess) const;

  ForcedMotions& motions_;
  const LeastCutParameters& params_;
  double tolerance_;
  std::map<std::vector<PartId>, Outlook> known_;  // valid during one call of best()
};

}  // namespace dismantle::least_cut
