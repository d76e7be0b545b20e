#include "blocking/params.h"

namespace dismantle {
namespace blocking {

using S = Schema<BlockingParams>;

void StraightParams::describe(S& s) {
  s.add<bool>("straight", &StraightParams::straight,
              {.doc = "Remove parts in straight lines wherever nothing is in the way (strategies target_first, "
                      "free_part), and use what is known of that (groups, rotations, simultaneous). "
                      "Off: every path is "
                      "searched for by the path planner."});
}

void FreeGroupParams::describe(S& s) {
  s.add<bool>("groups", &FreeGroupParams::groups,
              {.doc = "Strategy free_group: when no single part is free, take out the smallest group that is, and take "
                      "it apart by itself."});
  s.add<unsigned>("group_proposals", &FreeGroupParams::group_proposals,
                  {.unit = "1",
                   .min = 1,
                   .doc = "Advanced. Groups that are proposed to the verifier before other strategies are tried."});
}

void RepeatedPathParams::describe(S& s) {
  s.add<bool>("repeated_paths", &RepeatedPathParams::repeated_paths,
              {.doc = "Strategy repeated_path: propose the path on which a part has left for its copies, displaced as "
                      "they are (screws, legs, clips). Off: each copy is searched for."});
  s.add<double>("repeated_similarity", &RepeatedPathParams::repeated_similarity,
                {.unit = "1",
                 .min = 0,
                 .max = 1,
                 .doc = "Advanced. Parts count as copies, too, when the edges of their boxes differ by less than this "
                        "share of the box's diagonal. 0 = only where the triangles are the same."});
  s.add<unsigned>("repeated_refusals", &RepeatedPathParams::repeated_refusals,
                  {.unit = "1",
                   .min = 1,
                   .doc = "Advanced. Proposals for one part that the verifier may refuse before it is searched for as "
                          "any other."});
}

void PartialTranslationParams::describe(S& s) {
  s.add<std::int64_t>(
      "translation_states", &PartialTranslationParams::translation_states,
      {.unit = "1",
       .min = 0,
       .max = 1e8,
       .doc = "Strategy partial_translation: when neither parts nor groups are free, largest number of states in the "
              "search for translations that leave parts part-way (puzzles). 0 = no such search."});
  s.add<unsigned>("translation_refusals", &PartialTranslationParams::translation_refusals,
                  {.unit = "1",
                   .min = 1,
                   .doc = "Advanced. The search is given up after this number of translations that the verifier "
                          "refused."});
  s.add<double>("translation_work", &PartialTranslationParams::translation_work,
                {.unit = "1",
                 .min = 0,
                 .doc = "Advanced. Pairs of edges that the first search for partial translations may compare."});
  s.add<double>("translation_work_growth", &PartialTranslationParams::translation_work_growth,
                {.unit = "1", .min = 1, .doc = "Advanced. Factor by which each later search may compare more."});
  s.add<double>("translation_inset", &PartialTranslationParams::translation_inset,
                {.unit = "1",
                 .min = 0.1,
                 .max = 0.5,
                 .min_open = true,
                 .max_open = true,
                 .doc = "Advanced. Share of the verifier's tolerance by which the search takes parts to be thinner."});
  s.add<double>(
      "translation_least_step", &PartialTranslationParams::translation_least_step,
      {.unit = "max_penetration",
       .min = 1e-3,
       .max = 1e4,
       .doc = "Advanced. Shortest translation, as a multiple of verify.max_penetration. Smaller: more states."});
  s.add<double>(
      "play", &PartialTranslationParams::play,
      {.unit = "max_penetration",
       .min = 0,
       .max = 1e4,
       .doc = "Advanced. Shorter motions up to contact only use up play: such a translation is not made, and a "
              "part that has moved by less has not moved. As a multiple of verify.max_penetration."});
  s.add<unsigned>(
      "translation_edges", &PartialTranslationParams::translation_edges,
      {.unit = "1",
       .min = 6,
       .doc = "Advanced. Largest number of edges between flat faces of a part for which the search is made. "
              "The effort grows with the square."});
  s.add<unsigned>("translation_axes", &PartialTranslationParams::translation_axes,
                  {.unit = "1", .min = 1, .max = 32, .doc = "Advanced. Axes along which parts move, at most."});
}

void RotationParams::describe(S& s) {
  s.add<bool>("rotations", &RotationParams::rotations,
              {.doc = "Strategy rotation_in_place: rotate parts about the axes of their round surfaces, and leave them "
                      "there where that frees another part (latches)."});
  s.add<unsigned>("rotation_axes", &RotationParams::rotation_axes,
                  {.unit = "1", .min = 1, .doc = "Advanced. Axes of one part, at most."});
  s.add<unsigned>(
      "rotation_stops", &RotationParams::rotation_stops,
      {.unit = "1", .min = 4, .doc = "Advanced. Orientations in a full turn at which the other parts are examined."});
  s.add<unsigned>("rotation_halvings", &RotationParams::rotation_halvings,
                  {.unit = "1", .max = 30, .doc = "Advanced. Bisections to find where a rotating part meets another."});
  s.add<unsigned>("rotation_sweeps", &RotationParams::rotation_sweeps,
                  {.unit = "1", .doc = "Advanced. Sweeps of pairs for one group as it is, at most."});
  s.add<unsigned>(
      "round_facets", &RotationParams::round_facets,
      {.unit = "1",
       .min = 5,
       .max = 1000,
       .doc = "Advanced. A surface is round if it has this number of facets per full turn at least. Smaller: "
              "axes of more parts are found, also of prisms."});
  s.add<double>(
      "round_share", &RotationParams::round_share,
      {.unit = "1",
       .min = 1e-4,
       .max = 0.5,
       .doc = "Advanced. Least share of a part's surface that is round about an axis. A part with no more than "
              "this share that is not round about it is a body of revolution, and is not rotated."});
}

void SimultaneousMotionParams::describe(S& s) {
  s.add<bool>("simultaneous", &SimultaneousMotionParams::simultaneous,
              {.doc = "Strategy simultaneous_motion: move two or three parts, each in its own way, where nothing else "
                      "is in the way of one of them (interlocks). Needs a path planner that can (bfs, guided)."});
  s.add<unsigned>("simultaneous_parts", &SimultaneousMotionParams::simultaneous_parts,
                  {.unit = "1", .min = 2, .doc = "Advanced. Parts that move simultaneously, at most."});
  s.add<unsigned>("simultaneous_sets", &SimultaneousMotionParams::simultaneous_sets,
                  {.unit = "1", .doc = "Advanced. Sets that are moved to depth 1, for one group as it is."});
  s.add<unsigned>("simultaneous_deep_sets", &SimultaneousMotionParams::simultaneous_deep_sets,
                  {.unit = "1", .doc = "Advanced. Those of them that are moved deeper: several parts moved."});
  s.add<unsigned>("simultaneous_depth", &SimultaneousMotionParams::simultaneous_depth,
                  {.unit = "1", .min = 1, .doc = "Advanced. Depth of these."});
  s.add<double>("simultaneous_share", &SimultaneousMotionParams::simultaneous_share,
                {.unit = "1",
                 .min = 0,
                 .doc = "Advanced. What simultaneous motions may cost, of what the searches for single parts have cost "
                        "until then; once these are over there is no limit."});
}

void PathSearchParams::describe(S& s) {
  s.add<bool>(
      "path_searches", &PathSearchParams::path_searches,
      {.doc = "Strategy path_search: rounds of searches by the path planner, one action deeper whenever no part "
              "left."});
  s.add<bool>("pair_searches", &PathSearchParams::pair_searches,
              {.doc = "Strategy pair_search: search for the paths of the last two parts of a group, in the end without "
                      "limit."});
  s.add<bool>("postponed_searches", &PathSearchParams::postponed_searches,
              {.doc = "Strategy postponed_search: before a group is given up, make the searches that were put off "
                      "because what they had touched was still there."});
  s.add<unsigned>(
      "max_depth", &PathSearchParams::max_depth,
      {.unit = "1", .min = 1, .max = 1e6, .doc = "Largest depth of the path searches, except those of pair_search."});
  s.add<unsigned>("depth_without_translations", &PathSearchParams::depth_without_translations,
                  {.unit = "1",
                   .min = 1,
                   .doc = "Advanced. Largest depth where all arrangements that translations reach were visited, and "
                          "none frees anything."});
  s.add<unsigned>("touched_parts", &PathSearchParams::touched_parts,
                  {.unit = "1",
                   .min = 1,
                   .doc = "Advanced. A search is repeated to the same depth when one of this number of parts that it "
                          "touched most has left."});
  s.add<double>("cost_octaves", &PathSearchParams::cost_octaves,
                {.unit = "1",
                 .min = 0,
                 .min_open = true,
                 .doc = "Advanced. Searches whose costs differ by less (as a power of two) come in the order of their "
                        "use."});
  s.add<unsigned>("pair_depth", &PathSearchParams::pair_depth,
                  {.unit = "1",
                   .min = 1,
                   .doc = "Advanced. Depth of the searches for one pair while other pairs wait, doubled up to this."});
}

}  // namespace blocking

void BlockingParams::describe(Schema<BlockingParams>& schema) {
  schema.add_choice("order", &BlockingParams::order,
                    {{"small_first", PartOrder::small_first, "ascending volume: screws and pins before the housing"},
                     {"as_given", PartOrder::as_given, "as the assembly lists its parts"},
                     {"large_first", PartOrder::large_first, "descending volume"}},
                    "Order in which parts are taken when several are free.");
  StraightParams::describe(schema);
  FreeGroupParams::describe(schema);
  RepeatedPathParams::describe(schema);
  PartialTranslationParams::describe(schema);
  RotationParams::describe(schema);
  SimultaneousMotionParams::describe(schema);
  PathSearchParams::describe(schema);
}

}  // namespace dismantle
