#include "configuration_cells/configuration_cells.h"

#include <fmt/format.h>

#include <utility>

#include "configuration_cells/pocket.h"
#include "dismantle/immobility/query.h"

namespace dismantle::immobility {

void ConfigurationCellsParams::describe(Schema<ConfigurationCellsParams>& s) {
  s.add("walk_checks", &ConfigurationCellsParams::walk_checks,
        {.unit = "1",
         .min = 1,
         .doc = "Poses that a random walk looks at first: where it gets away there is nothing to prove."});
  s.add("max_divisions", &ConfigurationCellsParams::max_divisions,
        {.unit = "1", .min = 1, .doc = "Boxes of poses that are divided before the proof is given up."});
}

std::optional<Certificate> ConfigurationCells::prove(const SeparationQuery& query, const RunContext& context) const {
  const auto pair = pair_of(query);
  if (!pair || !near_each_other(query, pair->first, pair->second)) return std::nullopt;
  // Turns of a small part move its points less, so its poses need fewer boxes.
  auto [a, b] = *pair;
  if (extent_of(query, b) < extent_of(query, a)) std::swap(a, b);
  const PocketEffort effort{static_cast<std::size_t>(params_.walk_checks),
                            static_cast<std::size_t>(params_.max_divisions)};
  const auto found_in = pocket(solids_of(query, a), solids_of(query, b), depth_allowed(query, a, b), effort, context);
  if (!found_in) return std::nullopt;
  const Vector6 most = found_in->lo.cwiseAbs().cwiseMax(found_in->hi.cwiseAbs());
  const double depth = query.assembly.initial_overlap(a, b) + query.margin();
  const double shift = most.tail<3>().norm(), turn = most.head<3>().norm();
  Certificate found;
  found.parts = {a, b};
  found.numbers = {{"depth", {depth}},
                   {"shift", {shift}},
                   {"turn", {turn}},
                   {"lower", {found_in->lo.data(), found_in->lo.data() + 6}},
                   {"upper", {found_in->hi.data(), found_in->hi.data() + 6}},
                   {"cells", {static_cast<double>(found_in->cells)}}};
  found.text = fmt::format(
      "{0} and {1} hold each other as rigid bodies: cutting in by less than {2:.4g}, {0} comes no further than {3:.4g} "
      "past {1} and turns by no more than {4:.4g} rad (proved over {5} boxes of poses)",
      name_of(query, a), name_of(query, b), input_length(query, depth), input_length(query, shift), turn,
      found_in->cells);
  return found;
}

}  // namespace dismantle::immobility
