/// Data that the physics simulators compute once per assembly.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "dismantle/sdf/contact_pair.h"
#include "dismantle/sdf/shape.h"
#include "dismantle/simulator.h"

namespace dismantle::sdf {

/// Shapes, and the allowed depth of each pair that overlaps in assembled position.
class PreparedShapes final : public PreparedAssembly {
 public:
  std::vector<Placed> placed;
  std::map<std::pair<PartId, PartId>, double> overlap;  ///< a < b; only pairs that overlap
  double tolerance = 0;                                 ///< of the verifier; assembly units
  double facet_allowance = 0;                           ///< allowed depth of a pair beyond its overlap; assembly units
  double contact_depth = 0;                             ///< ContactDepths::contact
  mutable RestContacts rest;                            ///< filled on demand by the worlds
  double allowed(PartId a, PartId b) const {
    const auto found = overlap.find(std::minmax(a, b));
    return found == overlap.end() ? 0.0 : found->second;
  }
};

/// Pairs may keep their overlap while they move (end of B.1). The facets of round fits overlap by varying amounts as
/// the parts slide, so each pair gets half its overlap again, at most PreparedShapes::facet_allowance. `tolerance`: as
/// for Simulator::prepare.
std::shared_ptr<PreparedShapes> prepare_shapes(const Assembly& assembly, const ShapeOptions& options, double tolerance,
                                               RunContext& context);

/// The shapes in `prepared`. @throws InputError that names the first part of the scene that was not prepared.
const PreparedShapes& shapes_of(const PreparedAssembly& prepared, const Assembly& assembly, const Scene& scene);

}  // namespace dismantle::sdf
