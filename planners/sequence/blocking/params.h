/// Parameters of the planner, each declared by the strategy that uses it. Parameters whose doc begins with "Advanced"
/// affect which plan is found, but rarely need tuning.
#pragma once

#include <cstdint>

#include "dismantle/parameters.h"
#include "one_by_one/one_by_one.h"

namespace dismantle {

struct BlockingParams;

namespace blocking {

/// Straight removals: free_part, target_first, and the pairwise relations that other strategies use.
struct StraightParams {
  bool straight = true;
  static void describe(Schema<BlockingParams>& schema);
};

struct FreeGroupParams {
  bool groups = true;
  unsigned group_proposals = 8;
  static void describe(Schema<BlockingParams>& schema);
};

struct RepeatedPathParams {
  bool repeated_paths = true;
  double repeated_similarity = 0.02;
  unsigned repeated_refusals = 3;
  static void describe(Schema<BlockingParams>& schema);
};

struct PartialTranslationParams {
  std::int64_t translation_states = 60'000;
  unsigned translation_refusals = 12;
  double translation_work = 5e8;
  double translation_work_growth = 4;
  double translation_inset = 0.3;
  double translation_least_step = 5;
  double play = 25;
  unsigned translation_edges = 3000;
  unsigned translation_axes = 9;
  static void describe(Schema<BlockingParams>& schema);
};

struct RotationParams {
  bool rotations = true;
  unsigned rotation_axes = 2;
  unsigned rotation_stops = 24;
  unsigned rotation_halvings = 4;
  unsigned rotation_sweeps = 300;
  unsigned round_facets = 9;
  double round_share = 0.02;
  static void describe(Schema<BlockingParams>& schema);
};

struct SimultaneousMotionParams {
  bool simultaneous = true;
  unsigned simultaneous_parts = 3;
  unsigned simultaneous_sets = 12;
  unsigned simultaneous_deep_sets = 2;
  unsigned simultaneous_depth = 4;
  double simultaneous_share = 1;
  static void describe(Schema<BlockingParams>& schema);
};

/// path_search, pair_search and postponed_search.
struct PathSearchParams {
  bool path_searches = true;
  bool pair_searches = true;
  bool postponed_searches = true;
  unsigned max_depth = 8;
  unsigned depth_without_translations = 4;
  unsigned touched_parts = 3;
  double cost_octaves = 0.5;
  unsigned pair_depth = 64;
  static void describe(Schema<BlockingParams>& schema);
};

}  // namespace blocking

struct BlockingParams : blocking::StraightParams,
                        blocking::FreeGroupParams,
                        blocking::RepeatedPathParams,
                        blocking::PartialTranslationParams,
                        blocking::RotationParams,
                        blocking::SimultaneousMotionParams,
                        blocking::PathSearchParams {
  PartOrder order = PartOrder::small_first;
  static void describe(Schema<BlockingParams>& schema);
};

}  // namespace dismantle
