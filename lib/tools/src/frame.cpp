#include "frame.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace dismantle::tools {

static bool recessed(fasteners::Drive drive) {
  using enum fasteners::Drive;
  return drive == hex_socket || drive == torx || drive == cross || drive == slot;
}

Frame::Frame(const Use& use, const Fastener& fastener) : mm(fastener.mm) {
  axes.col(2) = fastener.axis;
  axes.col(0) = fastener.axis.unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  // A tool around a head does not touch what the head lies on.
  const double below = recessed(fastener.drive) ? 0 : std::min(use.depth, 0.9 * fastener.grip);
  origin = fastener.top - below / mm * fastener.axis;
}

std::vector<Volume> swept(const Use& use, const Fastener& fastener, bool hand) {
  std::vector<Volume> out = use.tool;
  if (hand) out.insert(out.end(), use.hand.begin(), use.hand.end());
  const double lift = fastener.travel + (use.from_side ? 0 : use.depth);
  for (Volume& v : out) {
    v.high += lift;
    if (use.beside && v.form != Form::tube) v.from.x() += fastener.radius, v.to.x() += fastener.radius;
  }
  return out;
}

}  // namespace dismantle::tools
