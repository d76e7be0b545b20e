/// Proof that two parts cannot be separated: a region of relative poses that no motion leaves.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "configuration_cells/configuration_cells.h"
#include "configuration_cells/decomposition_record.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility/linear_bound.h"
#include "dismantle/run_context.h"

namespace dismantle::immobility {

struct ConfigurationCage {
  /// Bounds of the region: rotation vector and shift of `a` relative to `b`, about the centre of `a`'s box.
  Vector6 lo = Vector6::Zero(), hi = Vector6::Zero();
  DecompositionProof proof;
};

/// Considers motions of `a` relative to `b` that begin assembled and penetrate by less than `depth` (> 0). Finds a
/// region that none of them leaves. Returns nullopt if not proved with the effort of `params`, or told to stop.
/// `tolerance` (> 0, assembly units) is the unit of lengths in `params`.
///
/// The proof is by approximate cell decomposition (Lozano-Perez 1983; Zhang, Kim and Manocha 2008). Interior samples
/// stay outside their obstacles. A box of poses around the assembled one is divided into cells; contract() bounds the
/// free poses of each. Two cells are neighbours when these bounds touch. A motion out of the box passes through
/// neighbours up to its border. So when no chain of neighbours leads from the cell of the assembled pose to the border,
/// there is no such motion. Only cells on a chain to the border are divided further. Where chains keep leading to the
/// same side, the box grows by a cell on that side, and the random search is directed there. Poses that it reaches must
/// be in the box, and if it separates the parts, there is nothing to prove.
std::optional<ConfigurationCage> cage_by_configuration_cells(const std::vector<Solid>& a, const std::vector<Solid>& b,
                                                             double depth, double tolerance,
                                                             const ConfigurationCellsParameters& params,
                                                             const RunContext& context);

}  // namespace dismantle::immobility
