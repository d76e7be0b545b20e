/// Motions of falling in words.
#pragma once

#include <string>

#include "dismantle/export.h"
#include "dismantle/statics/pile.h"

namespace dismantle::statics {

/// "falls down", "slides towards -x", "tips towards +y": what the motion does with the body. Axes are those of the
/// pile.
DISMANTLE_API std::string motion_text(const Body& body, const Motion& motion, const Eigen::Vector3d& down);

}  // namespace dismantle::statics
