#include "configuration_cells/configuration_cells.h"

#include <fmt/format.h>

#include <utility>

#include "configuration_cells/cage.h"
#include "dismantle/immobility/query.h"

namespace dismantle::immobility {

void ConfigurationCellsParameters::describe(Schema<ConfigurationCellsParameters>& s) {
  s.advanced("walk_checks", &ConfigurationCellsParameters::walk_checks, {1});
  s.add("max_divisions", &ConfigurationCellsParameters::max_divisions,
        {.unit = "1",
         .min = 1,
         .doc = "Limit of divided cells of relative poses, after which the proof is given up. Time grows in "
                "proportion: about half a minute for the default."});
  s.advanced("patience", &ConfigurationCellsParameters::patience, {1});
  s.advanced("sample_spacing", &ConfigurationCellsParameters::sample_spacing, {.min = 0, .min_open = true});
  s.advanced("smallest_cell", &ConfigurationCellsParameters::smallest_cell, {.min = 0, .min_open = true});
  s.advanced("separation", &ConfigurationCellsParameters::separation, {.min = 0, .min_open = true});
}

std::optional<Certificate> ConfigurationCells::prove(const SeparationQuery& query, const RunContext& context) const {
  const auto pair = pair_of(query);
  if (!pair || !near_each_other(query, pair->first, pair->second)) return std::nullopt;
  // The smaller part moves: a rotation displaces its points less, so fewer cells are needed.
  auto [a, b] = *pair;
  if (extent_of(query, b) < extent_of(query, a)) std::swap(a, b);
  const auto cage = cage_by_configuration_cells(solids_of(query, a), solids_of(query, b), depth_allowed(query, a, b),
                                                query.tolerance, params_, context);
  if (!cage) return std::nullopt;
  const Vector6 most = cage->lo.cwiseAbs().cwiseMax(cage->hi.cwiseAbs());
  const double depth = query.assembly.initial_overlap(a, b) + query.margin();
  const double shift = most.tail<3>().norm(), turn = most.head<3>().norm();
  Certificate found;
  found.parts = {a, b};
  found.numbers = {{"depth", {depth}},
                   {"shift", {shift}},
                   {"turn", {turn}},
                   {"lower", {cage->lo.data(), cage->lo.data() + 6}},
                   {"upper", {cage->hi.data(), cage->hi.data() + 6}},
                   {"cells", {static_cast<double>(cage->proof.leaves)}},
                   {"points", cage->proof.points},
                   {"directions", cage->proof.directions},
                   {"box", cage->proof.box},
                   {"tree", cage->proof.tree}};
  found.text = fmt::format(
      "{0} and {1} hold each other as rigid bodies: while they penetrate less than {2:.4g}, {0} moves no further than "
      "{3:.4g} relative to {1} and turns by no more than {4:.4g} rad (proved over {5} cells of poses)",
      name_of(query, a), name_of(query, b), input_length(query, depth), input_length(query, shift), turn,
      cage->proof.leaves);
  return found;
}

}  // namespace dismantle::immobility
