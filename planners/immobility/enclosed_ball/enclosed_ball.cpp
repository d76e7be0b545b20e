#include "enclosed_ball/enclosed_ball.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "dismantle/immobility/query.h"
#include "dismantle/part_memo.h"
#include "enclosed_ball/ball_free_space.h"

namespace dismantle::immobility {
namespace {

/// A large ball within a part, in the part's assembled frame.
Ball ball_of(const SeparationQuery& query, PartId part, std::uint64_t most_cubes) {
  return *query.memo.get<Ball>("large ball, " + std::to_string(most_cubes), part, RunContext{}, [&] {
    std::optional<Ball> largest{Ball{}};
    if (is_open(query, part)) return largest;  // no inside
    for (const Solid& solid : solids_of(query, part))
      if (const Ball b = inscribed_ball(solid, most_cubes); b.radius > largest->radius)
        largest = Ball{solid.frame * b.center, b.radius};
    return largest;
  });
}

/// Obstacles for the centre of a ball of `part`, and the part of each.
struct Walls {
  std::vector<Wall> all;
  std::vector<PartId> of;
};

Walls walls_of(const SeparationQuery& query, PartId part, double radius, const std::vector<PlacedPart>& outer) {
  Walls walls;
  for (const auto& p : outer) {
    if (is_open(query, p.part)) continue;  // fewer walls prove less, but nothing false
    const double distance = radius - query.assembly.initial_overlap(part, p.part) - query.margin();
    if (!(distance > 0)) continue;
    for (const Solid& solid : solids_of(query, p.part)) {
      walls.all.push_back({&solid, p.pose * solid.frame, distance});
      walls.of.push_back(p.part);
    }
  }
  return walls;
}

std::vector<PlacedPart> those(const std::vector<PlacedPart>& placed, const std::vector<PartId>& parts) {
  std::vector<PlacedPart> found;
  for (const PartId id : parts)
    found.push_back(*std::find_if(placed.begin(), placed.end(), [id](const PlacedPart& p) { return p.part == id; }));
  return found;
}

std::vector<PartId> distinct(const std::vector<PartId>& parts) {
  std::vector<PartId> found;
  for (const PartId id : parts)
    if (std::find(found.begin(), found.end(), id) == found.end()) found.push_back(id);
  return found;
}

}  // namespace

void EnclosedBallParameters::describe(Schema<EnclosedBallParameters>& s) {
  s.advanced("max_cubes", &EnclosedBallParameters::max_cubes, {1});
  s.advanced("max_cells", &EnclosedBallParameters::max_cells, {1});
}

ProverTraits EnclosedBall::traits() const noexcept {
  return {ProofEffort::low, 2, std::numeric_limits<std::size_t>::max(), true};
}

std::optional<Certificate> EnclosedBall::prove(const SeparationQuery& query, const RunContext& context) const {
  if (query.moving.empty() || query.fixed.empty()) return std::nullopt;
  if (auto found = prove(query, query.moving, query.fixed, context)) return found;
  // Relative to a single moving part, all others move as one body, so the ball may be in one of them. Parts of a moving
  // group may move relative to each other.
  return query.moving.size() == 1 ? prove(query, query.fixed, query.moving, context) : std::nullopt;
}

std::optional<Certificate> EnclosedBall::prove(const SeparationQuery& query, const std::vector<PlacedPart>& inner,
                                               const std::vector<PlacedPart>& outer, const RunContext& context) const {
  Ball ball;
  PlacedPart holder;
  for (const auto& p : inner)
    if (const Ball b = ball_of(query, p.part, static_cast<std::uint64_t>(params_.max_cubes)); b.radius > ball.radius) {
      ball = b;
      holder = p;
    }
  if (!(ball.radius > 0)) return std::nullopt;
  const auto most_cells = static_cast<std::size_t>(params_.max_cells);
  const Eigen::Vector3d center = holder.pose * ball.center;
  const Walls walls = walls_of(query, holder.part, ball.radius, outer);
  const FreeSpace space = flood_free_space(center, walls.all, most_cells, context);
  if (!space.closed) return std::nullopt;
  std::vector<PartId> around;
  for (const std::size_t w : space.bounds) around.push_back(walls.of[w]);
  around = distinct(around);
  // The claim names only the parts that bound the free space, if these alone close it.
  const Walls bounding = walls_of(query, holder.part, ball.radius, those(outer, around));
  if (!flood_with_cells(center, bounding.all, space.cell, most_cells, context).closed) around = distinct(walls.of);

  Certificate found;
  found.parts = {holder.part};
  found.parts.insert(found.parts.end(), around.begin(), around.end());
  found.poses = {holder.pose};
  for (const PlacedPart& p : those(outer, around)) found.poses.push_back(p.pose);
  found.numbers = {{"center", numbers_of(ball.center)}, {"radius", {ball.radius}}, {"cell", {space.cell}}};
  found.text = fmt::format(
      "{} is enclosed by {}: a ball of radius {:.4g} about {}, which it contains, is too large for every way out (less "
      "the penetration that is allowed)",
      name_of(query, holder.part), names_of(query, around), input_length(query, ball.radius),
      position_text(query, center));
  return found;
}

}  // namespace dismantle::immobility
