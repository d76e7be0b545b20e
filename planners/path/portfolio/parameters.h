/// Parameters of the portfolio path planner.
#pragma once

#include <cstdint>
#include <vector>

#include "dismantle/parameters.h"
#include "dismantle/path_planner.h"

namespace dismantle::portfolio {

enum class Mode { fallback, alternate };
enum class Size { any, small, large };

/// One planner of the portfolio, and the searches in which it participates.
struct Member {
  PluginRef<PathPlanner> plugin{};
  std::int64_t after = 0;
  bool whole = false;
  std::int64_t max_steps = 0;
  double share = 1;  ///< The largest share of `run.path_steps` that it may spend, if there is such a limit.
  bool depth_limited = true;
  std::int64_t least_depth = 0;
  std::int64_t least_depth_large = 0;  ///< The same for large groups, if it is more than `least_depth`.
  /// A group is large when the diagonal of its bounding box is more than this share of the diagonal of the fixed parts'
  /// box.
  double large = 0.5;
  /// The groups for which it participates. any: all groups; small: groups that are not `large`; large: groups that are
  /// `large`.
  Size size = Size::any;
  bool first = false;  ///< Under a depth limit it runs before all members without this key.
  /// Under a depth limit: if the first member was exhausted and the verifier has refused paths of it, this member
  /// participates at any depth and runs without a depth limit. Such paths lead out but penetrate a little too deeply.
  bool when_refused = false;
  /// When it is exhausted, the portfolio is exhausted as well. For members whose search is complete.
  bool final = false;

  static void describe(Schema<Member>& s) {
    s.add("after", &Member::after,
          {.unit = "1",
           .min = 0,
           .max = 1e12,
           .doc = "`alternate`: begins when the first member has spent this many steps and state checks, or has ended. "
                  "Larger: the first member has more time alone."});
    s.add("whole", &Member::whole, {.doc = "`alternate`: its first turn lasts until it ends."});
    s.add(
        "max_steps", &Member::max_steps,
        {.unit = "1", .min = 0, .max = 1e12, .doc = "Steps and state checks after which it is stopped; 0: no limit."});
    s.advanced("share", &Member::share, {.min = 0, .max = 1, .min_open = true});
    s.add("depth_limited", &Member::depth_limited, {.doc = "Participates in searches with a depth limit."});
    s.add("least_depth", &Member::least_depth,
          {.unit = "1", .min = 0, .max = 1000, .doc = "Least depth limit with which it participates."});
    s.advanced("least_depth_large", &Member::least_depth_large, {0, 1000});
    s.advanced("large", &Member::large, {0, 1000});
    s.advanced("size", &Member::size, {{"any", Size::any}, {"small", Size::small}, {"large", Size::large}});
    s.advanced("first", &Member::first);
    s.advanced("when_refused", &Member::when_refused);
    s.advanced("final", &Member::final);
  }
};

struct Parameters {
  Mode mode = Mode::alternate;
  Mode depth_limited_mode = Mode::fallback;
  std::vector<Member> of;
  std::int64_t turn = 30'000;
  double growth = 2;  ///< `alternate`: factor from the turns of one round to the next.
  /// `alternate`: length of the first turn of the first member instead of `turn`, for a group that is thinner than its
  /// initial overlap. The next round has the length `turn`. 0: no exception.
  std::int64_t overlap_turn = 0;
  /// `fallback` without `run.path_steps`: an idle thread may run the other members concurrently with the first one.
  /// Results do not depend on it.
  bool speculative = true;

  static void describe(Schema<Parameters>& s) {
    const std::vector<EnumChoice<Mode>> modes{
        {"fallback", Mode::fallback, "one after the other: a member begins when the one before has found nothing"},
        {"alternate", Mode::alternate,
         "in turns that grow, so that the sum is at most a few times the cost of the best"}};
    s.add_choice<Mode>("mode", &Parameters::mode, modes, "How members share a search without a depth limit.");
    s.add_choice<Mode>("depth_limited_mode", &Parameters::depth_limited_mode, modes,
                       "How members share a search with a depth limit.");
    s.add("of", &Parameters::of,
          {.doc = "The members, in order. If none finds a path, the outcome is that of the first one."});
    s.add("turn", &Parameters::turn,
          {.unit = "1",
           .min = 1,
           .max = 1e12,
           .doc = "`alternate`: steps and state checks of the turns of the first round."});
    s.advanced("growth", &Parameters::growth, {1, 100});
    s.advanced("overlap_turn", &Parameters::overlap_turn, {0, 1e12});
    s.advanced("speculative", &Parameters::speculative);
  }
};

}  // namespace dismantle::portfolio
