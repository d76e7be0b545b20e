/// What a user states about the weights and supports of an assembly.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/statics/stability.h"

namespace dismantle::statics {

/// Supports, friction and densities as text, as the check `gravity` has them.
class DISMANTLE_API StatedModel {
 public:
  /// `fixed`: names or patterns with * and ?, with commas between them; `density`: NAME=G_PER_CM3 likewise.
  /// @throws std::invalid_argument for a density that cannot be read.
  StatedModel(const std::string& fixed, double friction, const std::string& density);

  StabilityOptions options(const Assembly& assembly) const;

 private:
  std::vector<std::string> fixed_;
  double friction_;
  std::vector<std::pair<std::string, double>> density_;
};

}  // namespace dismantle::statics
