/// What the physics simulators compute once for an assembly.
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

/// Shapes, and the depth to which each pair overlaps when assembled.
class PreparedShapes final : public PreparedAssembly {
 public:
  std::vector<Placed> placed;
  std::map<std::pair<PartId, PartId>, double> overlap;  ///< a < b; only pairs that overlap
  double tolerance = 0;                                 ///< of the verifier; assembly units
  double facet_allowance = 0;  ///< what a pair may overlap beyond its depth when assembled; assembly units
  double contact_depth = 0;    ///< ContactDepths::contact
  mutable RestContacts rest;   ///< filled by the worlds as they need it
  double allowed(PartId a, PartId b) const {
    const auto found = overlap.find(std::minmax(a, b));
    return found == overlap.end() ? 0.0 : found->second;
  }
};

/// What overlaps when assembled may overlap as deep while it moves, pair by pair (end of B.1). Round fits overlap by
/// the facets of their meshes, more or less as they slide: they get half as much again, at most
/// PreparedShapes::facet_allowance. `tolerance`: as for Simulator::prepare.
std::shared_ptr<PreparedShapes> prepare_shapes(const Assembly& assembly, const ShapeOptions& options, double tolerance,
                                               RunContext& context);

/// The shapes in `prepared`. @throws InputError naming the first part of the scene that was not prepared.
const PreparedShapes& shapes_of(const PreparedAssembly& prepared, const Assembly& assembly, const Scene& scene);

}  // namespace dismantle::sdf
