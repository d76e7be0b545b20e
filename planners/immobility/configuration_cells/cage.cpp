#include "configuration_cells/cage.h"

#include <algorithm>

#include "configuration_cells/cell_decomposition.h"
#include "configuration_cells/free_space_sampler.h"

namespace dismantle::immobility {

std::optional<ConfigurationCage> cage_by_configuration_cells(const std::vector<Solid>& a, const std::vector<Solid>& b,
                                                             double depth, double tolerance,
                                                             const ConfigurationCellsParameters& params,
                                                             const RunContext& context) {
  if (!all_closed(a) || !all_closed(b)) return std::nullopt;
  const SampledPair pair(a, b, depth, params.sample_spacing * tolerance);
  if (pair.samples().empty()) return std::nullopt;
  const double separated = std::max(pair.radius(), params.separation * tolerance);
  FreeSpaceSampler sampler(pair, separated, tolerance);
  sampler.explore(static_cast<std::size_t>(params.walk_checks), context);
  if (sampler.separated()) return std::nullopt;
  ForkJoin fork_join(context);
  CellDecomposition cells(pair, sampler, params, {2 * separated, tolerance}, fork_join);
  if (cells.run(context) != CellDecomposition::End::closed) return std::nullopt;
  return ConfigurationCage{cells.bounds().lo, cells.bounds().hi, cells.proof(static_cast<std::uint32_t>(a.size()))};
}

}  // namespace dismantle::immobility
