#include "blocking/params.h"

namespace dismantle {
namespace blocking {

using S = Schema<BlockingParams>;

void StraightParams::describe(S& s) {
  s.add<bool>("straight", &StraightParams::straight,
              {.doc = "Remove parts along straight lines where nothing blocks them (strategies target_first, "
                      "free_part). Off: free_group, rotation_in_place and simultaneous_motion are off, too."});
}

void FreeGroupParams::describe(S& s) {
  s.add<bool>("groups", &FreeGroupParams::groups,
              {.doc = "Strategy free_group: when no single part is free, remove the smallest free group and "
                      "disassemble it separately."});
  s.add<unsigned>(
      "group_proposals", &FreeGroupParams::group_proposals,
      {.unit = "1",
       .min = 1,
       .doc = "Advanced. Largest number of groups proposed to the verifier before other strategies are tried."});
}

void RepeatedPathParams::describe(S& s) {
  s.add<bool>("repeated_paths", &RepeatedPathParams::repeated_paths,
              {.doc = "Strategy repeated_path: propose the path of a removed part for its copies (screws, legs, "
                      "clips), displaced as they are. Off: every copy needs its own search."});
  s.add<double>("repeated_similarity", &RepeatedPathParams::repeated_similarity,
                {.unit = "1",
                 .min = 0,
                 .max = 1,
                 .doc = "Advanced. Parts whose box edges differ by less than this share of the box diagonal also count "
                        "as copies. 0 = only parts with the same triangles."});
  s.add<unsigned>("repeated_refusals", &RepeatedPathParams::repeated_refusals,
                  {.unit = "1",
                   .min = 1,
                   .doc = "Advanced. Number of refused proposals after which a part is left to the other strategies."});
}

void PartialTranslationParams::describe(S& s) {
  s.add<std::int64_t>(
      "translation_states", &PartialTranslationParams::translation_states,
      {.unit = "1",
       .min = 0,
       .max = 1e8,
       .doc = "Strategy partial_translation: when no part or group is free, search for translations to intermediate "
              "placements (puzzles). Largest number of states in this search; 0 = no search."});
  s.add<unsigned>(
      "translation_refusals", &PartialTranslationParams::translation_refusals,
      {.unit = "1",
       .min = 1,
       .doc = "Advanced. The search is given up after the verifier has refused this number of translations."});
  s.add<double>(
      "translation_work", &PartialTranslationParams::translation_work,
      {.unit = "1",
       .min = 0,
       .doc = "Advanced. Largest number of pairs of edges that the first search for partial translations compares."});
  s.add<double>("translation_work_growth", &PartialTranslationParams::translation_work_growth,
                {.unit = "1",
                 .min = 1,
                 .doc = "Advanced. Factor on translation_work for every further depth of the path searches."});
  s.add<double>("translation_inset", &PartialTranslationParams::translation_inset,
                {.unit = "1",
                 .min = 0.1,
                 .max = 0.5,
                 .min_open = true,
                 .max_open = true,
                 .doc = "Advanced. Inset of the surfaces in this search, as a share of the verifier's tolerance."});
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
       .doc = "Advanced. Motions shorter than this only use up clearance: no such translation to contact is made, and "
              "simultaneous_motion does not count such a part as moved. As a multiple of verify.max_penetration."});
  s.add<unsigned>("translation_edges", &PartialTranslationParams::translation_edges,
                  {.unit = "1",
                   .min = 6,
                   .doc = "Advanced. Largest number of edges between flat faces of a part with which the search runs. "
                          "The effort grows with the square."});
  s.add<unsigned>(
      "translation_axes", &PartialTranslationParams::translation_axes,
      {.unit = "1", .min = 1, .max = 32, .doc = "Advanced. Largest number of axes along which parts move."});
}

void RotationParams::describe(S& s) {
  s.add<bool>("rotations", &RotationParams::rotations,
              {.doc = "Strategy rotation_in_place: rotate a part about the axis of a round surface, and leave it "
                      "rotated if that frees another part (latches)."});
  s.add<unsigned>("rotation_axes", &RotationParams::rotation_axes,
                  {.unit = "1", .min = 1, .doc = "Advanced. Largest number of axes of one part."});
  s.add<unsigned>(
      "rotation_stops", &RotationParams::rotation_stops,
      {.unit = "1", .min = 4, .doc = "Advanced. Orientations per full turn at which the other parts are examined."});
  s.add<unsigned>("rotation_halvings", &RotationParams::rotation_halvings,
                  {.unit = "1", .max = 30, .doc = "Advanced. Bisections to find where a rotating part meets another."});
  s.add<unsigned>("rotation_sweeps", &RotationParams::rotation_sweeps,
                  {.unit = "1", .doc = "Advanced. Largest number of pair sweeps for one group, until it changes."});
  s.add<unsigned>("round_facets", &RotationParams::round_facets,
                  {.unit = "1",
                   .min = 5,
                   .max = 1000,
                   .doc = "Advanced. A surface is round if it has at least this number of facets per full turn. "
                          "Smaller: more axes are found, also those of prisms."});
  s.add<double>("round_share", &RotationParams::round_share,
                {.unit = "1",
                 .min = 1e-4,
                 .max = 0.5,
                 .doc = "Advanced. Smallest share of a part's surface that has to be round about an axis. If no more "
                        "than this share is not round about it, the part is a body of revolution and is not rotated."});
}

void SimultaneousMotionParams::describe(S& s) {
  s.add<bool>(
      "simultaneous", &SimultaneousMotionParams::simultaneous,
      {.doc = "Strategy simultaneous_motion: move two or three parts, each along its own path, where the others are "
              "the only blockers of one of them (interlocks). Needs a path planner that supports this (bfs, guided)."});
  s.add<unsigned>("simultaneous_parts", &SimultaneousMotionParams::simultaneous_parts,
                  {.unit = "1", .min = 2, .doc = "Advanced. Largest number of parts that move simultaneously."});
  s.add<unsigned>(
      "simultaneous_sets", &SimultaneousMotionParams::simultaneous_sets,
      {.unit = "1",
       .doc = "Advanced. Largest number of sets that are moved, to depth 1, for one group until it changes."});
  s.add<unsigned>(
      "simultaneous_deep_sets", &SimultaneousMotionParams::simultaneous_deep_sets,
      {.unit = "1", .doc = "Advanced. Largest number of these sets that are moved deeper, if several parts moved."});
  s.add<unsigned>("simultaneous_depth", &SimultaneousMotionParams::simultaneous_depth,
                  {.unit = "1", .min = 1, .doc = "Advanced. Depth to which these sets are moved."});
  s.add<double>("simultaneous_share", &SimultaneousMotionParams::simultaneous_share,
                {.unit = "1",
                 .min = 0,
                 .doc = "Advanced. Largest cost of simultaneous motions, as a share of the cost of the searches for "
                        "single parts so far. No limit once these searches are over."});
}

void PathSearchParams::describe(S& s) {
  s.add<bool>(
      "path_searches", &PathSearchParams::path_searches,
      {.doc = "Strategy path_search: rounds of searches by the path planner, one action deeper whenever no part "
              "left."});
  s.add<bool>("pair_searches", &PathSearchParams::pair_searches,
              {.doc = "Strategy pair_search: search for paths of the last two parts of a group, in the end without a "
                      "depth limit."});
  s.add<bool>("postponed_searches", &PathSearchParams::postponed_searches,
              {.doc = "Strategy postponed_search: before a group is given up, make the searches that were postponed "
                      "because the parts that they had touched were still there."});
  s.add<unsigned>(
      "max_depth", &PathSearchParams::max_depth,
      {.unit = "1", .min = 1, .max = 1e6, .doc = "Largest depth of the path searches, except those of pair_search."});
  s.add<unsigned>("depth_without_translations", &PathSearchParams::depth_without_translations,
                  {.unit = "1",
                   .min = 1,
                   .doc = "Advanced. Largest depth if all arrangements that translations reach were visited and none "
                          "of them frees a part."});
  s.add<unsigned>("touched_parts", &PathSearchParams::touched_parts,
                  {.unit = "1",
                   .min = 1,
                   .doc = "Advanced. Number of most touched parts that are considered: a search is repeated to the "
                          "same depth when one of them has left."});
  s.add<double>("cost_octaves", &PathSearchParams::cost_octaves,
                {.unit = "1",
                 .min = 0,
                 .min_open = true,
                 .doc = "Advanced. Width of a cost class of searches, in powers of two. Within a class, parts that "
                        "block more others come first."});
  s.add<unsigned>("pair_depth", &PathSearchParams::pair_depth,
                  {.unit = "1",
                   .min = 1,
                   .doc = "Advanced. While other pairs wait, the depth of the searches for a pair doubles up to this; "
                          "then it is not limited."});
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
