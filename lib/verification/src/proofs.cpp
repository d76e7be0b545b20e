// That parts cannot leave: what the verifier proves of pairs and of what is around them.
#include <algorithm>

#include "disc/disc_cage.h"
#include "hook_cage.h"
#include "interlock/interlock.h"
#include "lock.h"
#include "pocket/pocket.h"
#include "ring_cage.h"
#include "verifier_impl.h"

namespace dismantle {
namespace {

/// Of the penetration that is allowed. What is not linear in poses grows with it: with all of it less is settled.
constexpr double kInterlockedShare = 0.5;

}  // namespace

std::optional<Lock> Verifier::Impl::locking_point(const InitialOverlap& o) const {
  const double allowed = o.depth + options.max_penetration;
  for (const auto& [inside, other] : {std::pair(o.a, o.b), std::pair(o.b, o.a)})
    for (const auto& x : bodies[inside].solids)
      for (const auto& y : bodies[other].solids)
        if (const auto p = verify::deep_common_point(x, x.frame, y, y.frame, allowed * (1 + 1e-9)))
          return Lock{inside, other, p->point, p->depth, allowed};
  return std::nullopt;
}

/// A large ball within a part, in the part's assembled frame.
verify::Ball Verifier::Impl::ball_of(PartId part) const {
  return *balls.at(part).get(RunContext{}, [&] {
    std::optional<verify::Ball> largest{verify::Ball{}};
    for (const auto& solid : bodies.at(part).solids)
      if (const verify::Ball b = verify::large_ball(solid); b.radius > largest->radius)
        largest = verify::Ball{solid.frame * b.center, b.radius};
    return largest;
  });
}

/// The largest ball of the inner parts against the surfaces of the outer ones. A surface point of those that is inside
/// the ball is so deep in the inner part as it is below the ball's surface, at least.
std::optional<Enclosure> Verifier::Impl::shut_in(const std::vector<PlacedPart>& inner,
                                                 const std::vector<PlacedPart>& outer) const {
  verify::Ball ball;
  Pose at;
  PartId part = 0;
  for (const auto& p : inner)
    if (const verify::Ball b = ball_of(p.part); b.radius > ball.radius) {
      ball = b;
      at = p.pose;
      part = p.part;
    }
  std::vector<verify::Wall> walls;
  std::vector<PartId> of;
  for (const auto& p : outer) {
    const double distance = ball.radius - overlap(part, p.part) - options.max_penetration;
    if (!(distance > 0)) continue;
    for (const auto& solid : bodies.at(p.part).solids) {
      walls.push_back({&solid, p.pose * solid.frame, distance});
      of.push_back(p.part);
    }
  }
  const verify::Room room = verify::room_of(at * ball.center, walls);
  if (!room.closed) return std::nullopt;
  Enclosure found{part, at * ball.center, ball.radius, {}};
  for (const std::size_t w : room.bounds)
    if (std::find(found.around.begin(), found.around.end(), of[w]) == found.around.end()) found.around.push_back(of[w]);
  return found;
}

auto Verifier::Impl::middles_of(PartId part, const RunContext& context) const -> const Middles* {
  return middles.at(part).get(context, [&]() -> std::optional<Middles> {
    Middles all;
    for (const auto& solid : bodies.at(part).solids)
      all.push_back(verify::middle_of(solid, 1.1 * options.max_penetration, context));
    if (context.should_stop()) return std::nullopt;
    return all;
  });
}

std::optional<Cage> Verifier::Impl::caged(PartId a, PartId b, const RunContext& context) const {
  const double depth = (overlap(a, b) + options.max_penetration) * (1 + 1e-6);
  constexpr std::size_t kRings = 2;
  Aabb near = bodies.at(a).box;
  near.inflate(options.max_penetration);
  if (!near.overlaps(bodies.at(b).box)) return std::nullopt;
  for (const auto& [inside, other] : {std::pair(a, b), std::pair(b, a)})
    for (const auto& x : bodies[inside].solids)
      for (const verify::InnerRing& ring : verify::rings_in(x, depth, kRings))
        for (const auto& y : bodies[other].solids)
          if (const auto cage = verify::ring_cage(ring, y, context))
            return Cage{Cage::Kind::ring, inside, other, ring.center, 2 * ring.radius, cage->opening};
  for (const auto& [inside, other] : {std::pair(a, b), std::pair(b, a)})
    for (const auto& x : bodies[inside].solids)
      for (const auto& y : bodies[other].solids)
        if (const auto cage = verify::spool_cage(x, y, depth, context))
          return Cage{Cage::Kind::spool, inside, other, cage->ring.center, cage->rim, 2 * cage->ring.radius};
  for (const auto& [inside, other] : {std::pair(a, b), std::pair(b, a)}) {
    const Middles* middle = middles_of(inside, context);
    if (middle == nullptr) return std::nullopt;
    for (std::size_t i = 0; i < bodies[inside].solids.size(); ++i)
      for (const auto& y : bodies[other].solids)
        if (const auto cage = verify::hook_cage(bodies[inside].solids[i], (*middle)[i], y, depth, context))
          return Cage{Cage::Kind::hook, inside, other, cage->hole, 0, cage->width};
  }
  return std::nullopt;
}

std::optional<Cage> Verifier::caged(PartId a, PartId b, const RunContext& context) const {
  if (a > b) std::swap(a, b);
  {
    const std::scoped_lock guard(impl_->cages_guard);
    if (const auto known = impl_->cages.find({a, b}); known != impl_->cages.end()) return known->second;
  }
  const auto found = impl_->caged(a, b, context);
  if (!found && context.should_stop()) return std::nullopt;  // says nothing
  const std::scoped_lock guard(impl_->cages_guard);
  return impl_->cages.try_emplace({a, b}, found).first->second;
}

std::optional<Cage> Verifier::caged_flat(PartId inside, PartId other, const RunContext& context) const {
  const auto& bodies = impl_->bodies;
  const double depth = (impl_->overlap(inside, other) + impl_->options.max_penetration) * (1 + 1e-6);
  const Impl::Middles* middle = impl_->middles_of(inside, context);
  if (middle == nullptr) return std::nullopt;
  for (std::size_t i = 0; i < middle->size(); ++i)
    for (const verify::InnerDisc& disc : verify::discs_in(bodies.at(inside).solids[i], (*middle)[i], depth, 1))
      if (verify::disc_cage(disc, bodies.at(other).solids, context))
        return Cage{Cage::Kind::disc, inside, other, disc.center, 2 * disc.radius, 0};
  return std::nullopt;
}

std::optional<Confinement> Verifier::confined(PartId a, PartId b, const RunContext& context, double share) const {
  // Turns of a small part move its points less, so its poses need fewer boxes.
  const auto extent = [&](PartId part) { return impl_->bodies.at(part).box.size().norm(); };
  if (extent(b) < extent(a) || (extent(b) == extent(a) && b < a)) std::swap(a, b);
  Aabb near = impl_->bodies.at(a).box;
  near.inflate(impl_->options.max_penetration);
  if (!near.overlaps(impl_->bodies.at(b).box)) return std::nullopt;
  const double depth = impl_->overlap(a, b) + share * impl_->options.max_penetration;
  const auto pocket =
      verify::pocket(impl_->bodies.at(a).solids, impl_->bodies.at(b).solids, depth * (1 + 1e-6), context);
  if (!pocket) return std::nullopt;
  const verify::Vector6 most = pocket->lo.cwiseAbs().cwiseMax(pocket->hi.cwiseAbs());
  return Confinement{a, b, depth, most.tail<3>().norm(), most.head<3>().norm(), pocket->cells};
}

std::optional<Interlock> Verifier::interlocked(std::vector<PartId> parts, const RunContext& context) const {
  const auto& bodies = impl_->bodies;
  const double share = kInterlockedShare * impl_->options.max_penetration;
  Interlock found{parts, share};
  std::sort(found.parts.begin(), found.parts.end());
  parts = found.parts;
  // Poses are told as seen from the first.
  std::stable_sort(parts.begin(), parts.end(),
                   [&](PartId a, PartId b) { return bodies.at(a).box.size().norm() > bodies.at(b).box.size().norm(); });
  std::vector<const std::vector<verify::Solid>*> solids;
  for (const PartId id : parts) solids.push_back(&bodies.at(id).solids);
  std::vector<verify::Neighbours> neighbours;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t k = i + 1; k < parts.size(); ++k) {
      Aabb near = bodies[parts[i]].box;
      near.inflate(impl_->options.max_penetration);
      if (near.overlaps(bodies[parts[k]].box))
        neighbours.push_back({i, k, (impl_->overlap(parts[i], parts[k]) + share) * (1 + 1e-6)});
    }
  const auto reach = verify::interlock(solids, neighbours, context);
  if (!reach) return std::nullopt;
  found.shift = reach->shift;
  found.turn = reach->turn;
  found.half_spaces = reach->half_spaces;
  return found;
}

std::optional<Enclosure> Verifier::shut_in(const std::vector<PlacedPart>& moving,
                                           const std::vector<PlacedPart>& still) const {
  if (moving.empty() || still.empty()) return std::nullopt;
  if (auto found = impl_->shut_in(moving, still)) return found;
  // Seen from a single part that moves, all others move as one body. Parts of a group may move against each other.
  return moving.size() == 1 ? impl_->shut_in(still, moving) : std::nullopt;
}

}  // namespace dismantle
