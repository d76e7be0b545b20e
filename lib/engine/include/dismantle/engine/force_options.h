/// When and how parts that no verified motion was found for are taken out all the same.
#pragma once

namespace dismantle {

/// When forced steps are made.
enum class ForceWhen { off, last_resort };

/// When parts without a verified path are taken out by force, and what that may cost.
struct ForceOptions {
  ForceWhen when = ForceWhen::off;
  double share = 0.15;       ///< of the time of the run, (0, 1): kept for forced steps and verified ones between them
  unsigned directions = 26;  ///< of the sphere, tried beside the axes of the parts' faces
  unsigned candidates = 24;  ///< motions per forced step whose depth is measured
  unsigned retry_depth = 3;  ///< >= 1, of the searches for the parts that are left after a forced step
};

}  // namespace dismantle
