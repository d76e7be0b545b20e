/// What kind of contact two parts have as they stand.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "dismantle/aabb.h"
#include "dismantle/export.h"

namespace dismantle {

/// How two parts are in each other when assembled (docs/concepts.md).
enum class ContactClass {
  clearance,             ///< near, and apart everywhere
  kissing,               ///< they touch without an overlap
  uniform_interference,  ///< an overlap of one depth all around an axis, or over a whole face: a press fit
  local_interference,    ///< an overlap of a small region of the common surface: a clip, a detent, a spring on its seat
  duplicate,             ///< both surfaces coincide
  inside,                ///< one lies in the solid of the other
};

/// The word that files and messages use.
DISMANTLE_API std::string_view to_string(ContactClass contact);
/// The class of that word; nothing for other words.
DISMANTLE_API std::optional<ContactClass> contact_class_from_string(std::string_view text);

/// Where two parts overlap, and how. The unit and the frame are those of the struct that holds it.
struct OverlapPlace {
  ContactClass contact = ContactClass::local_interference;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< the deepest point
  Aabb region;                                   ///< of all surface points of one part in the other
  double share = 0;  ///< of the surfaces that face each other nearby, what overlaps: [0, 1] of the area
  std::optional<Eigen::Vector3d> axis{};                 ///< unit; of a uniform overlap all around an axis
  Eigen::Vector3d axis_point = Eigen::Vector3d::Zero();  ///< on the axis, where there is one
};

}  // namespace dismantle
