#include "hook/hook.h"

#include <fmt/format.h>

#include "dismantle/immobility/medial_balls.h"
#include "dismantle/immobility/query.h"
#include "hook/hook_cage.h"

namespace dismantle::immobility {
namespace {

std::vector<double> legs_of(const Bend& bend) {
  std::vector<double> numbers;
  for (const Eigen::Vector3d& leg : bend.along) numbers.insert(numbers.end(), leg.begin(), leg.end());
  return numbers;
}

}  // namespace

void HookParameters::describe(Schema<HookParameters>& s) {
  s.advanced("max_holes", &HookParameters::max_holes, {1});
  s.advanced("max_bends", &HookParameters::max_bends, {1});
  s.advanced("max_nodes", &HookParameters::max_nodes, {8});
  s.advanced("max_distances", &HookParameters::max_distances, {1});
  s.advanced("min_bend", &HookParameters::min_bend, {0, 1.57});
}

std::optional<Certificate> Hook::prove(const SeparationQuery& query, const RunContext& context) const {
  const auto pair = pair_of(query);
  if (!pair || !near_each_other(query, pair->first, pair->second)) return std::nullopt;
  const double depth = depth_allowed(query, pair->first, pair->second);
  for (const auto& [inside, other] : both_orders(*pair)) {
    const auto* balls = medial_balls_of(query, inside, context);
    if (balls == nullptr) return std::nullopt;
    const auto& bars = solids_of(query, inside);
    for (std::size_t i = 0; i < bars.size(); ++i)
      for (const Solid& y : solids_of(query, other)) {
        const auto cage = hook_cage(bars[i], (*balls)[i], y, depth, params_, context);
        if (!cage) continue;
        Certificate found;
        found.parts = {inside, other};
        found.numbers = {{"hole", numbers_of(cage->hole)},
                         {"width", {cage->width}},
                         {"first_bend", numbers_of(cage->bends[0].corner)},
                         {"second_bend", numbers_of(cage->bends[1].corner)},
                         {"normal", numbers_of(cage->normal)},
                         {"first_legs", legs_of(cage->bends[0])},
                         {"second_legs", legs_of(cage->bends[1])}};
        for (const Bend& bend : cage->bends) {
          found.numbers["steps"].push_back(bend.step);
          found.numbers["points"].push_back(static_cast<double>(bend.keep.size()));
        }
        for (const Eigen::Vector3d& p : cage->path)
          found.numbers["path"].insert(found.numbers["path"].end(), p.begin(), p.end());
        found.text = fmt::format(
            "{0} and {1} hold each other: {0} goes through a hole in {1} at {2}, {3:.4g} wide, and is "
            "bent on both sides; neither bend can pass the hole (less the penetration that is allowed)",
            name_of(query, inside), name_of(query, other), position_text(query, cage->hole),
            input_length(query, cage->width));
        return found;
      }
  }
  return std::nullopt;
}

}  // namespace dismantle::immobility
