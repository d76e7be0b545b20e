#include "disc/disc.h"

#include <fmt/format.h>

#include <utility>

#include "disc/disc_cage.h"
#include "dismantle/immobility/medial_balls.h"
#include "dismantle/immobility/query.h"

namespace dismantle::immobility {

namespace {

std::vector<double> numbers_of(const Pose& pose) {
  return {pose.t.x(), pose.t.y(), pose.t.z(), pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z()};
}

std::vector<double> numbers_of(const std::vector<Eigen::Vector3d>& vectors) {
  std::vector<double> numbers;
  for (const auto& v : vectors) numbers.insert(numbers.end(), v.begin(), v.end());
  return numbers;
}

std::vector<double> numbers_of(const std::vector<Aabb>& boxes) {
  std::vector<Eigen::Vector3d> corners;
  for (const Aabb& box : boxes) corners.insert(corners.end(), {box.lo, box.hi});
  return numbers_of(corners);
}

}  // namespace

void DiscParameters::describe(Schema<DiscParameters>& s) {
  s.advanced("max_discs", &DiscParameters::max_discs, {1});
  s.add("max_divisions", &DiscParameters::max_divisions,
        {.unit = "1",
         .min = 1,
         .doc = "Limit of divided cells of positions of the disc's centre, after which the proof is given up."});
  s.advanced("max_facets", &DiscParameters::max_facets, {1});
}

std::optional<Certificate> Disc::prove(const SeparationQuery& query, const RunContext& context) const {
  const auto pair = pair_of(query);
  if (!pair) return std::nullopt;
  auto [inside, other] = *pair;
  if (extent_of(query, other) < extent_of(query, inside)) std::swap(inside, other);
  const double depth = depth_allowed(query, inside, other);
  const auto* balls = medial_balls_of(query, inside, context);
  if (balls == nullptr) return std::nullopt;
  const auto& solids = solids_of(query, inside);
  for (std::size_t i = 0; i < balls->size(); ++i)
    for (const InteriorDisc& disc :
         discs_in(solids[i], (*balls)[i], depth, static_cast<std::size_t>(params_.max_discs))) {
      const auto cage = disc_cage(disc, solids_of(query, other), slack_of(query), params_, context);
      if (!cage) continue;
      Certificate found;
      found.parts = {inside, other};
      found.numbers = {{"center", numbers_of(disc.center)},   {"axis", numbers_of(disc.axis)},
                       {"diameter", {2 * disc.radius}},       {"half_thickness", {disc.half}},
                       {"frame", numbers_of(cage->frame)},    {"region", numbers_of(cage->region)},
                       {"normals", numbers_of(cage->normals)}};
      found.text = fmt::format(
          "{0} and {1} hold each other: {0} has a flat disc of diameter {2:.4g} about {3} in a chamber of {1}, and it "
          "passes none of the openings in any orientation (less the penetration that is allowed)",
          name_of(query, inside), name_of(query, other), input_length(query, 2 * disc.radius),
          position_text(query, disc.center));
      return found;
    }
  return std::nullopt;
}

}  // namespace dismantle::immobility
