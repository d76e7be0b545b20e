#include "blocking/parameters.h"

namespace dismantle {

void BlockingParameters::describe(Schema<BlockingParameters>& s) {
  s.add_choice("order", &BlockingParameters::order, part_orders(),
               "Order in which parts are taken when several are free.");
  s.add("straight", &BlockingParameters::straight,
        {.doc = "Remove parts along straight lines where nothing blocks them (strategies target_first, "
                "free_part). Off: free_group, rotation_in_place and simultaneous_motion are off, too."});
  s.add_choice(
      "upwards", &BlockingParameters::upwards,
      {{"auto", blocking::Upwards::automatic, "on inside a best_order, otherwise off"},
       {"on", blocking::Upwards::on,
        "parts that can leave straight up (layout.up) leave first, then parts and groups that can leave sideways, "
        "at last what leaves downwards: the reverse puts the base down first, and what is on it from above"},
       {"off", blocking::Upwards::off, "directions are all the same"}},
      "Whether what leaves upwards goes first.");
  s.add("groups", &BlockingParameters::groups,
        {.doc = "Strategy free_group: when no single part is free, remove the smallest free group and "
                "disassemble it separately."});
  s.advanced("group_proposals", &BlockingParameters::group_proposals, {1});
  s.add("repeated_paths", &BlockingParameters::repeated_paths,
        {.doc = "Strategy repeated_path: propose the path of a removed part for its copies (screws, legs, "
                "clips), displaced as they are. Off: every copy needs its own search."});
  s.advanced("repeated_similarity", &BlockingParameters::repeated_similarity, {0, 1});
  s.advanced("repeated_refusals", &BlockingParameters::repeated_refusals, {1});
  s.add("translation_states", &BlockingParameters::translation_states,
        {.unit = "1",
         .min = 0,
         .max = 1e8,
         .doc = "Strategy partial_translation: when no part or group is free, search for translations to intermediate "
                "placements (puzzles). Largest number of states in this search; 0 = no search."});
  s.advanced("translation_refusals", &BlockingParameters::translation_refusals, {1});
  s.advanced("translation_work", &BlockingParameters::translation_work, {0});
  s.advanced("translation_work_growth", &BlockingParameters::translation_work_growth, {1});
  s.advanced("translation_inset", &BlockingParameters::translation_inset,
             {.min = 0.1, .max = 0.5, .min_open = true, .max_open = true});
  s.advanced("translation_least_step", &BlockingParameters::translation_least_step, {1e-3, 1e4});
  s.advanced("play", &BlockingParameters::play, {0, 1e4});
  s.advanced("translation_edges", &BlockingParameters::translation_edges, {6});
  s.advanced("translation_axes", &BlockingParameters::translation_axes, {1, 32});
  s.add("rotations", &BlockingParameters::rotations,
        {.doc = "Strategy rotation_in_place: rotate a part about the axis of a round surface, and leave it "
                "rotated if that frees another part (latches)."});
  s.advanced("rotation_axes", &BlockingParameters::rotation_axes, {1});
  s.advanced("rotation_stops", &BlockingParameters::rotation_stops, {4});
  s.advanced("rotation_halvings", &BlockingParameters::rotation_halvings, {.max = 30});
  s.advanced("rotation_sweeps", &BlockingParameters::rotation_sweeps);
  s.advanced("round_facets", &BlockingParameters::round_facets, {5, 1000});
  s.advanced("round_share", &BlockingParameters::round_share, {1e-4, 0.5});
  s.add(
      "simultaneous", &BlockingParameters::simultaneous,
      {.doc = "Strategy simultaneous_motion: move two or three parts, each along its own path, where the others are "
              "the only blockers of one of them (interlocks). Needs a path planner that supports this (bfs, guided)."});
  s.advanced("simultaneous_parts", &BlockingParameters::simultaneous_parts, {2});
  s.advanced("simultaneous_sets", &BlockingParameters::simultaneous_sets);
  s.advanced("simultaneous_deep_sets", &BlockingParameters::simultaneous_deep_sets);
  s.advanced("simultaneous_depth", &BlockingParameters::simultaneous_depth, {1});
  s.advanced("simultaneous_share", &BlockingParameters::simultaneous_share, {0});
  s.add("path_searches", &BlockingParameters::path_searches,
        {.doc = "Strategy path_search: rounds of searches by the path planner, one action deeper whenever no part "
                "left."});
  s.add("pair_searches", &BlockingParameters::pair_searches,
        {.doc = "Strategy pair_search: search for paths of the last two parts of a group, in the end without a "
                "depth limit."});
  s.add("postponed_searches", &BlockingParameters::postponed_searches,
        {.doc = "Strategy postponed_search: before a group is given up, make the searches that were postponed "
                "because the parts that they had touched were still there."});
  s.add("max_depth", &BlockingParameters::max_depth,
        {.unit = "1", .min = 1, .max = 1e6, .doc = "Largest depth of the path searches, except those of pair_search."});
  s.advanced("depth_without_translations", &BlockingParameters::depth_without_translations, {1});
  s.advanced("depth_of_rotations", &BlockingParameters::depth_of_rotations, {1});
  s.advanced("touched_parts", &BlockingParameters::touched_parts, {1});
  s.advanced("cost_octaves", &BlockingParameters::cost_octaves, {.min = 0, .min_open = true});
  s.add(
      "snap_share", &BlockingParameters::snap_share,
      {.unit = "1",
       .min = 0,
       .max = 1,
       .doc = "A part is held by a snap fit if a straight motion out cuts in by no more than this share of the smaller "
              "part. It has to bend: when a few deep searches of such parts have found nothing, the others are "
              "searched for to depth 1 only, if parts may be forced (run.force). 0: no part."});
  s.advanced("snap_failures", &BlockingParameters::snap_failures, {1, 1000});
  s.advanced("snap_depth", &BlockingParameters::snap_depth, {2, 1000});
  s.advanced("snap_depth_of_few", &BlockingParameters::snap_depth_of_few, {2, 1000});
  s.advanced("snap_directions", &BlockingParameters::snap_directions, {1, 1000});
  s.advanced("snap_poses", &BlockingParameters::snap_poses, {1});
  s.advanced("snap_group", &BlockingParameters::snap_group);
  s.advanced("pair_depth", &BlockingParameters::pair_depth, {1});
}

}  // namespace dismantle
