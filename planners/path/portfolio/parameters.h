/// Parameters of the portfolio path planner.
#pragma once

#include <cstdint>
#include <vector>

#include "dismantle/parameters.h"
#include "dismantle/path_planner.h"

namespace dismantle::portfolio {

enum class Mode { fallback, alternate };
enum class Size { any, small, large };

/// One planner of the portfolio, and when it takes part.
struct Member {
  PluginRef<PathPlanner> plugin{};
  std::int64_t after = 0;
  bool whole = false;
  std::int64_t max_steps = 0;
  double share = 1;
  bool depth_limited = true;
  std::int64_t least_depth = 0;
  std::int64_t least_depth_large = 0;
  double large = 0.5;
  Size size = Size::any;
  bool first = false;
  bool when_refused = false;
  bool final = false;

  static void describe(Schema<Member>& s) {
    s.add("after", &Member::after,
          {.unit = "1",
           .min = 0,
           .max = 1e12,
           .doc = "`alternate`: takes part once the first member has spent this many steps and state checks, or has "
                  "ended."});
    s.add("whole", &Member::whole, {.doc = "`alternate`: its first turn lasts until it ends."});
    s.add("max_steps", &Member::max_steps,
          {.unit = "1", .min = 0, .max = 1e12, .doc = "Steps and state checks after which it is given up; 0: none."});
    s.add("share", &Member::share,
          {.unit = "1",
           .min = 0,
           .max = 1,
           .min_open = true,
           .doc = "The largest share of `run.path_steps` that it may spend, where there is such a limit."});
    s.add("depth_limited", &Member::depth_limited, {.doc = "Takes part in searches with a depth limit."});
    s.add("least_depth", &Member::least_depth,
          {.unit = "1", .min = 0, .max = 1000, .doc = "Takes part only where the depth limit is at least this."});
    s.add(
        "least_depth_large", &Member::least_depth_large,
        {.unit = "1", .min = 0, .max = 1000, .doc = "The same for large groups, where it is more than `least_depth`."});
    s.add("large", &Member::large,
          {.unit = "1",
           .min = 0,
           .max = 1000,
           .doc = "A group is large when the diagonal of its bounding box is more than this share of the diagonal of "
                  "the fixed parts' box."});
    s.add_choice<Size>("size", &Member::size,
                       {{"any", Size::any, "all groups"},
                        {"small", Size::small, "groups that are not `large`"},
                        {"large", Size::large, "groups that are `large`"}},
                       "The groups for which it takes part.");
    s.add("first", &Member::first,
          {.doc = "Under a depth limit it runs before the members without this key, whatever its place in the list."});
    s.add(
        "when_refused", &Member::when_refused,
        {.doc = "Under a depth limit: where the first member was exhausted and the verifier refused paths of it, this "
                "one takes part at any depth, and runs without a depth limit. Such paths lead out and cut in a little "
                "too deep."});
    s.add("final", &Member::final,
          {.doc = "When it ends as `exhausted`, the portfolio does, too. For members whose search is complete."});
  }
};

struct Parameters {
  Mode mode = Mode::alternate;
  Mode depth_limited_mode = Mode::fallback;
  std::vector<Member> of;
  std::int64_t turn = 30'000;
  double growth = 2;
  std::int64_t overlap_turn = 0;
  bool speculative = true;

  static void describe(Schema<Parameters>& s) {
    const std::vector<EnumChoice<Mode>> modes{
        {"fallback", Mode::fallback, "one after the other: the next one begins when the one before has found nothing"},
        {"alternate", Mode::alternate,
         "in turns that grow, so that the sum is at most a few times the cost of the best"}};
    s.add_choice<Mode>("mode", &Parameters::mode, modes, "How members share a search without a depth limit.");
    s.add_choice<Mode>("depth_limited_mode", &Parameters::depth_limited_mode, modes,
                       "How members share a search with a depth limit.");
    s.add("of", &Parameters::of,
          {.doc = "The members, in order. What the first one says is the outcome where none finds a path."});
    s.add("turn", &Parameters::turn,
          {.unit = "1",
           .min = 1,
           .max = 1e12,
           .doc = "`alternate`: steps and state checks of the turns of the first round."});
    s.add("growth", &Parameters::growth,
          {.unit = "1", .min = 1, .max = 100, .doc = "`alternate`: factor from the turns of one round to the next."});
    s.add("overlap_turn", &Parameters::overlap_turn,
          {.unit = "1",
           .min = 0,
           .max = 1e12,
           .doc = "`alternate`: length of the very first turn of the first member in place of `turn`, where the group "
                  "is thinner than its initial overlap; the round after it has the length `turn` again. 0: no "
                  "exception."});
    s.add("speculative", &Parameters::speculative,
          {.doc = "`fallback` without `run.path_steps`: an idle thread may run the other members beside the first one. "
                  "Results do not depend on it."});
  }
};

}  // namespace dismantle::portfolio
