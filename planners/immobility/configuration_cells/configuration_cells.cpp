#include "configuration_cells/configuration_cells.h"

#include <fmt/format.h>

#include <utility>

#include "configuration_cells/cage.h"
#include "dismantle/immobility/query.h"

namespace dismantle::immobility {

void ConfigurationCellsParams::describe(Schema<ConfigurationCellsParams>& s) {
  s.add("walk_checks", &ConfigurationCellsParams::walk_checks,
        {.unit = "1",
         .min = 1,
         .doc = "State checks of the random search that precedes the proof. If it separates the parts, no proof is "
                "tried. Too few checks waste time on proofs that must fail."});
  s.add("max_divisions", &ConfigurationCellsParams::max_divisions,
        {.unit = "1",
         .min = 1,
         .doc = "Limit of divided cells of relative poses, after which the proof is given up. Time grows in "
                "proportion: about half a minute for the default."});
  s.add("patience", &ConfigurationCellsParams::patience,
        {.unit = "1",
         .min = 1,
         .doc = "Advanced. Divisions without progress after which the random search extends to where cells lead, and "
                "the decomposed box grows on a side to which all of them lead. Lower values react sooner to long free "
                "motions, higher values spend fewer state checks."});
  s.add("sample_spacing", &ConfigurationCellsParams::sample_spacing,
        {.unit = "verify.max_penetration",
         .min = 0,
         .min_open = true,
         .doc = "Advanced. Distance between the interior points that the proof uses. Fewer points are faster, but miss "
                "contacts of small features. It is larger in large parts, so that each part has at most a few thousand "
                "points."});
  s.add("smallest_cell", &ConfigurationCellsParams::smallest_cell,
        {.unit = "verify.max_penetration",
         .min = 0,
         .min_open = true,
         .doc = "Advanced. Cells with a smaller displacement between their poses are not divided. If a way out leads "
                "through one, the proof is given up."});
  s.add(
      "separation", &ConfigurationCellsParams::separation,
      {.unit = "verify.max_penetration",
       .min = 0,
       .min_open = true,
       .doc =
           "Advanced. Displacement at which the random search counts the parts as separated, or the radius of the "
           "smaller part, if that is more. It must exceed the distance that parts can slide without being separated."});
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
