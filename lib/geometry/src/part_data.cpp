#include "dismantle/geometry/part_data.h"

#include <optional>
#include <utility>

#include "dismantle/geometry/hull.h"

namespace dismantle::geometry {

const std::vector<Solid>& solids_of(const Assembly& assembly, PartId part, PartMemo& memo, double tolerance) {
  return *memo.get<std::vector<Solid>>("solids", part, RunContext{}, [&] {
    std::vector<Solid> solids = split_into_solids(*assembly.parts.at(part).mesh);
    for (Solid& solid : solids) solid.measure_thickness(4 * tolerance);
    return std::optional(std::move(solids));
  });
}

const std::vector<Eigen::Vector3d>& hull_of(const Assembly& assembly, PartId part, PartMemo& memo) {
  return *memo.get<std::vector<Eigen::Vector3d>>(
      "hull", part, RunContext{}, [&] { return std::optional(hull_corners(assembly.parts.at(part).mesh->vertices)); });
}

}  // namespace dismantle::geometry
