// The frame of a tool on a fastener.
#pragma once

#include <Eigen/Core>

#include "dismantle/tools/access.h"

namespace dismantle::tools {

/// Millimetres, as in Volume.
struct Frame {
  Eigen::Matrix3d axes;  // columns, in the assembly
  Eigen::Vector3d origin;
  double mm;

  Frame(const Use& use, const Fastener& fastener);
  Eigen::Vector3d inward(const Eigen::Vector3d& p) const { return mm * (axes.transpose() * (p - origin)); }
  Eigen::Vector3d outward(const Eigen::Vector3d& p) const { return axes * p / mm + origin; }
};

/// The volumes of a tool and the hand on their whole travel along the axis.
std::vector<Volume> swept(const Use& use, const Fastener& fastener, bool hand);

}  // namespace dismantle::tools
