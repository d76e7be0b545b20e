/// Steps 3 to 6 of appendix B.1: which parts stay. Input units.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/mesh.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// A part during preparation: its repaired surface and the index of its report.
struct Candidate {
  std::string name;
  std::string file;
  std::size_t report = 0;  ///< index in PrepareReport::parts
  Mesh mesh;
  Aabb box;
  double volume = 0;
  bool open = false;  ///< its surface is a wall
  std::optional<Rgba> colour;
  std::vector<std::string> parents, instances;
  std::string product;
  std::optional<double> density;
  bool flexible = false;  ///< RawPart::flexible
  std::string unit;

  std::unique_ptr<TriangleBvh> bvh() const {
    return std::make_unique<TriangleBvh>(mesh, geometry::Poll{}, open ? Surface::open : Surface::closed);
  }
};

/// Candidates to remove from the assembly, with the reasons.
using Dropped = std::vector<std::pair<std::size_t, std::string>>;  ///< (index, reason), ascending

Dropped find_duplicates(const std::vector<Candidate>& candidates, const RunContext& context);
Dropped find_overlapping(const std::vector<Candidate>& candidates, double max_share, const RunContext& context);
Dropped find_thin(const std::vector<Candidate>& candidates, double min_thickness, const RunContext& context);

/// Groups of parts whose convex hulls are no further apart than `gap`, the largest first (then by first part).
std::vector<std::vector<std::size_t>> connected_groups(const std::vector<Candidate>& candidates, double gap,
                                                       const RunContext& context);

Aabb box_of(const std::vector<Candidate>& candidates);

}  // namespace dismantle
