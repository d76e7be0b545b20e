/// When and how parts without a verified motion are removed by force: the section `force:`.
#pragma once

#include <cstddef>
#include <cstdint>

#include "dismantle/export.h"
#include "dismantle/parameters.h"

namespace dismantle {

/// When forced steps are made.
enum class ForceWhen { off, last_resort };

/// When parts without a verified path are removed by force, and what that may cost. Docs and ranges are in describe().
struct ForceOptions {
  ForceWhen when = ForceWhen::off;  ///< the key `run.force`
  double share = 0.15;
  double verified_share = 0.25;
  double quick_margin = 2;
  double overtime = 0.5;  ///< seconds

  unsigned directions = 26;
  unsigned part_axes = 6;
  unsigned group_axes = 16;
  unsigned quick_axes = 4;
  unsigned rays = 24;
  double blocking_share = 0.02;
  double firm_share = 0.3;
  double clearance = 2;  ///< tolerances
  double max_turns = 100;

  unsigned candidates = 24;
  unsigned set_candidates = 4;
  double set_similarity = 0.9;  ///< cosine
  unsigned depth_samples = 48;
  double coarse_resolution = 8;  ///< tolerances
  double coarse_share = 0.1;
  std::int64_t coarse_poses = 200;
  unsigned finalists = 4;
  double fine_share = 0.03;
  std::int64_t fine_poses = 400;

  unsigned retry_depth = 3;

  DISMANTLE_API static void describe(Schema<ForceOptions>& s);
};

}  // namespace dismantle
