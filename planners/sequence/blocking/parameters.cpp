#include "blocking/parameters.h"

namespace dismantle {

void BlockingParams::describe(Schema<BlockingParams>& s) {
  s.add_choice("order", &BlockingParams::order, part_orders(), "Order in which parts are taken when several are free.");
  s.add("straight", &BlockingParams::straight,
        {.doc = "Remove parts along straight lines where nothing blocks them (strategies target_first, "
                "free_part). Off: free_group, rotation_in_place and simultaneous_motion are off, too."});
  s.add_choice(
      "upwards", &BlockingParams::upwards,
      {{"auto", blocking::Upwards::automatic, "on inside a best_order, otherwise off"},
       {"on", blocking::Upwards::on,
        "parts that can leave straight up (layout.up) leave first, then parts and groups that can leave sideways, "
        "at last what leaves downwards: the reverse puts the base down first, and what is on it from above"},
       {"off", blocking::Upwards::off, "directions are all the same"}},
      "Whether what leaves upwards goes first.");
  s.add("groups", &BlockingParams::groups,
        {.doc = "Strategy free_group: when no single part is free, remove the smallest free group and "
                "disassemble it separately."});
  s.advanced("group_proposals", &BlockingParams::group_proposals, {1});
  s.add("repeated_paths", &BlockingParams::repeated_paths,
        {.doc = "Strategy repeated_path: propose the path of a removed part for its copies (screws, legs, "
                "clips), displaced as they are. Off: every copy needs its own search."});
  s.advanced("repeated_similarity", &BlockingParams::repeated_similarity, {0, 1});
  s.advanced("repeated_refusals", &BlockingParams::repeated_refusals, {1});
  s.add("translation_states", &BlockingParams::translation_states,
        {.unit = "1",
         .min = 0,
         .max = 1e8,
         .doc = "Strategy partial_translation: when no part or group is free, search for translations to intermediate "
                "placements (puzzles). Largest number of states in this search; 0 = no search."});
  s.advanced("translation_refusals", &BlockingParams::translation_refusals, {1});
  s.advanced("translation_work", &BlockingParams::translation_work, {0});
  s.advanced("translation_work_growth", &BlockingParams::translation_work_growth, {1});
  s.advanced("translation_inset", &BlockingParams::translation_inset,
             {.min = 0.1, .max = 0.5, .min_open = true, .max_open = true});
  s.advanced("translation_least_step", &BlockingParams::translation_least_step, {1e-3, 1e4});
  s.advanced("play", &BlockingParams::play, {0, 1e4});
  s.advanced("translation_edges", &BlockingParams::translation_edges, {6});
  s.advanced("translation_axes", &BlockingParams::translation_axes, {1, 32});
  s.add("rotations", &BlockingParams::rotations,
        {.doc = "Strategy rotation_in_place: rotate a part about the axis of a round surface, and leave it "
                "rotated if that frees another part (latches)."});
  s.advanced("rotation_axes", &BlockingParams::rotation_axes, {1});
  s.advanced("rotation_stops", &BlockingParams::rotation_stops, {4});
  s.advanced("rotation_halvings", &BlockingParams::rotation_halvings, {.max = 30});
  s.advanced("rotation_sweeps", &BlockingParams::rotation_sweeps);
  s.advanced("round_facets", &BlockingParams::round_facets, {5, 1000});
  s.advanced("round_share", &BlockingParams::round_share, {1e-4, 0.5});
  s.add(
      "simultaneous", &BlockingParams::simultaneous,
      {.doc = "Strategy simultaneous_motion: move two or three parts, each along its own path, where the others are "
              "the only blockers of one of them (interlocks). Needs a path planner that supports this (bfs, guided)."});
  s.advanced("simultaneous_parts", &BlockingParams::simultaneous_parts, {2});
  s.advanced("simultaneous_sets", &BlockingParams::simultaneous_sets);
  s.advanced("simultaneous_deep_sets", &BlockingParams::simultaneous_deep_sets);
  s.advanced("simultaneous_depth", &BlockingParams::simultaneous_depth, {1});
  s.advanced("simultaneous_share", &BlockingParams::simultaneous_share, {0});
  s.add("path_searches", &BlockingParams::path_searches,
        {.doc = "Strategy path_search: rounds of searches by the path planner, one action deeper whenever no part "
                "left."});
  s.add("pair_searches", &BlockingParams::pair_searches,
        {.doc = "Strategy pair_search: search for paths of the last two parts of a group, in the end without a "
                "depth limit."});
  s.add("postponed_searches", &BlockingParams::postponed_searches,
        {.doc = "Strategy postponed_search: before a group is given up, make the searches that were postponed "
                "because the parts that they had touched were still there."});
  s.add("max_depth", &BlockingParams::max_depth,
        {.unit = "1", .min = 1, .max = 1e6, .doc = "Largest depth of the path searches, except those of pair_search."});
  s.advanced("depth_without_translations", &BlockingParams::depth_without_translations, {1});
  s.advanced("depth_of_rotations", &BlockingParams::depth_of_rotations, {1});
  s.advanced("touched_parts", &BlockingParams::touched_parts, {1});
  s.advanced("cost_octaves", &BlockingParams::cost_octaves, {.min = 0, .min_open = true});
  s.add(
      "snap_share", &BlockingParams::snap_share,
      {.unit = "1",
       .min = 0,
       .max = 1,
       .doc = "A part is held by a snap fit if a straight motion out cuts in by no more than this share of the smaller "
              "part. It has to bend: when a few deep searches of such parts have found nothing, the others are "
              "searched for to depth 1 only, if parts may be forced (run.force). 0: no part."});
  s.advanced("snap_failures", &BlockingParams::snap_failures, {1, 1000});
  s.advanced("snap_depth", &BlockingParams::snap_depth, {2, 1000});
  s.advanced("snap_depth_of_few", &BlockingParams::snap_depth_of_few, {2, 1000});
  s.advanced("snap_directions", &BlockingParams::snap_directions, {1, 1000});
  s.advanced("snap_group", &BlockingParams::snap_group);
  s.advanced("pair_depth", &BlockingParams::pair_depth, {1});
}

}  // namespace dismantle
