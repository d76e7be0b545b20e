/// Parameters of the bfs path planner.
#pragma once

#include "dismantle/push_search/parameters.h"

namespace dismantle::bfs {

enum class Variant {
  shared,     ///< the search that bfs shares with contact_search
  published,  ///< Algorithm 1 as implemented in the code published with the paper
};

enum class Order { first_come, longest_first };

struct Parameters : push::SearchParameters {
  Variant variant = Variant::shared;
  /// Order of the states of one level under `variant: published`. first_come: in the order in which they were reached;
  /// longest_first: those with the longest way from the start first.
  Order order = Order::longest_first;
  double torque = 0;  ///< Torque of each action with `variant: published`. 0: `force` times the part's radius (N unit).
  /// With `variant: published`: two ends of runs are one state if they are nearer than this, and rotated by less than
  /// `distinct_rotation` (assembly units).
  double distinct_translation = 0.05;
  double distinct_rotation = 0.2;  ///< Rotation limit for `distinct_translation` (rad).

  static void describe(Schema<Parameters>& s) {
    s.add_choice<Variant>(
        "variant", &Parameters::variant,
        {{"shared", Variant::shared, "the search that bfs shares with contact_search"},
         {"published", Variant::published,
          "level by level, as the code published with the paper; without `diagonals`, `intermediate`, "
          "`translation_nodes`, `rotation_nodes`"}},
        "How the tree of states is searched.");
    push::describe_search(s);
    s.advanced("order", &Parameters::order,
               {{"first_come", Order::first_come}, {"longest_first", Order::longest_first}});
    s.advanced("torque", &Parameters::torque, {0});
    s.advanced("distinct_translation", &Parameters::distinct_translation, {.min = 0, .min_open = true});
    s.advanced("distinct_rotation", &Parameters::distinct_rotation, {.min = 0, .max = 3.2, .min_open = true});
  }

  push::Tactics tactics() const {
    push::Tactics t;
    static_cast<push::SearchParameters&>(t) = *this;
    t.translating = {push::Stage::axes};
    t.rotating = {push::Stage::axes};
    if (diagonals) push::add_diagonals(t);
    return t;
  }
};

}  // namespace dismantle::bfs
