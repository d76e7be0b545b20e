#include "frame.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace dismantle::tools {

static bool recessed(fasteners::Drive drive) {
  using enum fasteners::Drive;
  return drive == hex_socket || drive == torx || drive == cross || drive == slot;
}

Eigen::Vector3d seat_of(const Use& use, const Fastener& fastener) {
  // A tool around a head does not touch what the head lies on.
  const double below = recessed(fastener.drive) ? 0 : std::min(use.depth, 0.9 * fastener.grip);
  return fastener.top - below / fastener.mm * fastener.axis;
}

std::vector<Volume> volumes_on(std::vector<Volume> volumes, const Use& use, const Fastener& fastener) {
  for (Volume& v : volumes)
    if (use.beside && v.form != Form::tube) v.from.x() += fastener.radius, v.to.x() += fastener.radius;
  return volumes;
}

Frame::Frame(const Use& use, const Fastener& fastener) : origin(seat_of(use, fastener)), mm(fastener.mm) {
  axes.col(2) = fastener.axis;
  axes.col(0) = fastener.axis.unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
}

std::vector<Volume> swept(const Use& use, const Fastener& fastener, bool hand) {
  std::vector<Volume> out = use.tool;
  if (hand) out.insert(out.end(), use.hand.begin(), use.hand.end());
  out = volumes_on(std::move(out), use, fastener);
  const double lift = fastener.travel + (use.from_side ? 0 : use.depth);
  for (Volume& v : out) v.high += lift;
  return out;
}

}  // namespace dismantle::tools
