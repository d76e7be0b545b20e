/// Work of the weights in a motion.
#pragma once

#include <Eigen/Core>

#include "dismantle/statics/pile.h"

namespace dismantle::statics {

/// Work of the weights of all bodies that can move, if gravity points along `down` (its length counts).
inline double weight_work(const Pile& pile, const Motions& motion, const Eigen::Vector3d& down) {
  double sum = 0;
  for (std::size_t i = 0; i < motion.size(); ++i)
    if (!pile.bodies[i].fixed) sum += pile.bodies[i].weight * motion[i].v.dot(down);
  return sum;
}

}  // namespace dismantle::statics
