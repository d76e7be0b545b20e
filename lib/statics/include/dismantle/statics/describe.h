/// Falling in words and numbers, for people and pictures.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/statics/pile.h"

namespace dismantle::statics {

/// "falls down", "slides towards -x", "tips towards +y": what the motion does with the body. Axes are those of the
/// pile.
DISMANTLE_API std::string motion_text(const Body& body, const Motion& motion, const Eigen::Vector3d& down);

/// What missing_text() says of a body whose support moves.
inline constexpr const char* kGivesWay = "what it rests on moves, too";

/// Why a body moves like this: "nothing is under it", "nothing is under its half towards -x" (seen from its centre of
/// mass), "nothing stops it there", "what it rests on moves, too". Empty: it leans on something that does not move, and
/// it is no simple reason.
DISMANTLE_API std::string missing_text(const Pile& pile, std::uint32_t body, const Motions& motions);

/// How a pile is drawn.
struct PictureFrame {
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> place;            ///< of a point of the pile in the picture
  double scale = 1;                                                        ///< of lengths
  std::function<std::vector<std::string>(std::uint32_t body)> names = {};  ///< of the parts of a body
};

/// {"falls": [{"parts", "center", "v", "w"}], "arrows": [{"kind", "part", "at", "force"}]}, as JSON text. `falls`: the
/// bodies that `motions` move; a point p goes by v + w x (p - center), and none of them further than 1, a length of the
/// picture; empty: there is none. `arrows`: on the bodies `of`, in newton: `weight`, `contact` (one for each contact,
/// at the middle of its forces) and, on what is held, `hold`, which balances the others.
DISMANTLE_API std::string picture_json(const Pile& pile, const Motions& motions, const ContactForces& forces,
                                       const std::vector<std::uint32_t>& of, const std::vector<std::uint32_t>& held,
                                       const PictureFrame& frame);

}  // namespace dismantle::statics
