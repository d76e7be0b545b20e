#include "dismantle/preparation/flexible_parts.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "dismantle/fasteners/strands.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/strand.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "parallel_phase.h"

namespace dismantle {
namespace {

using geometry::Strand;

/// Share of the loop's turns along which its surface is inside the other part.
double clasped(const Strand& loop, const TriangleBvh& other) {
  double in = 0;
  for (std::size_t k = 0; k < loop.stations.size(); ++k) {
    const auto& rim = loop.stations[k].rim;
    for (std::size_t i = 0; i < rim.size(); ++i) {
      if (!other.inside(rim[i]) && !other.inside((rim[i] + rim[(i + 1) % rim.size()]) / 2)) continue;
      in += loop.turns[k];
      break;
    }
  }
  return in / std::accumulate(loop.turns.begin(), loop.turns.end(), 0.0);
}

bool may_bend(const InitialOverlap& pair) {
  if (!(pair.depth > 0) || pair.declared) return false;
  return !pair.place || (pair.place->contact != ContactClass::inside && pair.place->contact != ContactClass::duplicate);
}

}  // namespace

double flexible_depth(const Part& part) {
  const double area = surface_area(*part.mesh);
  return area > 0 ? 4 * part.volume / area : 0;
}

static TriangleBvh bvh_of(const Part& part) {
  return TriangleBvh(*part.mesh, geometry::Poll{}, part.open ? Surface::open : Surface::closed);
}

std::optional<Flexible> flexible_shape(const Mesh& mesh) {
  const auto strand = geometry::follow_strand(mesh);
  return strand ? fasteners::strand_kind(*strand) : std::nullopt;
}

std::vector<FlexiblePart> recognise_flexible(Assembly& assembly, const RunContext& context,
                                             const std::vector<std::string>* only) {
  std::vector<std::vector<std::size_t>> pairs(assembly.parts.size());  // by part: its overlaps
  for (std::size_t i = 0; i < assembly.overlaps.size(); ++i)
    if (may_bend(assembly.overlaps[i])) {
      pairs[assembly.overlaps[i].a].push_back(i);
      pairs[assembly.overlaps[i].b].push_back(i);
    }
  std::vector<PartId> asked;
  for (const Part& part : assembly.parts)
    if (!part.open && !pairs[part.id].empty() && (only == nullptr || std::find(only->begin(), only->end(), part.name) != only->end()))
      asked.push_back(part.id);
  const auto other_of = [&](PartId part, std::size_t pair) {
    return assembly.overlaps[pair].a == part ? assembly.overlaps[pair].b : assembly.overlaps[pair].a;
  };
  std::vector<std::optional<Flexible>> kinds(asked.size());
  parallel_phase(
      asked.size(), context, "flexible parts",
      [&](std::size_t i) {
        const PartId part = asked[i];
        const auto strand = geometry::follow_strand(*assembly.parts[part].mesh);
        kinds[i] = strand ? fasteners::strand_kind(*strand) : std::nullopt;
        if (kinds[i] == Flexible::loop)  // a part in less than a quarter of its turns is another link of a chain
          std::erase_if(pairs[part], [&](std::size_t pair) {
            return clasped(*strand, bvh_of(assembly.parts[other_of(part, pair)])) < 0.25;
          });
      },
      [&](std::size_t i) { return assembly.parts[asked[i]].name; });
  std::vector<FlexiblePart> found;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const Part& part = assembly.parts[asked[i]];
    if (!kinds[i] || pairs[part.id].empty()) continue;
    FlexiblePart& bends = found.emplace_back(FlexiblePart{part.name, *kinds[i], flexible_depth(part), {}});
    for (const std::size_t pair : pairs[part.id]) {
      bends.others.push_back(assembly.parts[other_of(part.id, pair)].name);
      InitialOverlap& overlap = assembly.overlaps[pair];
      overlap.declared = std::max(overlap.allowed(), bends.depth);
    }
  }
  return found;
}

std::vector<FlexiblePart> with_declared(std::vector<FlexiblePart> recognised, const std::vector<std::string>& declared,
                                        const Assembly& assembly) {
  for (const std::string& name : declared) {
    std::erase_if(recognised, [&](const FlexiblePart& f) { return f.part == name; });
    const auto part =
        std::find_if(assembly.parts.begin(), assembly.parts.end(), [&](const Part& p) { return p.name == name; });
    if (part != assembly.parts.end()) recognised.push_back({name, Flexible::declared, flexible_depth(*part), {}});
  }
  return recognised;
}

}  // namespace dismantle
