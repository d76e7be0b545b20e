/// Kinds of contact between two parts when assembled.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "dismantle/aabb.h"
#include "dismantle/export.h"

namespace dismantle {

/// Contact of two parts when assembled (docs/concepts.md).
enum class ContactClass {
  clearance,             ///< near, and apart everywhere
  kissing,               ///< they touch without an overlap
  uniform_interference,  ///< an overlap of one depth all around an axis, or over a whole face: a press fit
  local_interference,    ///< an overlap of a small region of the common surface: a clip, a detent, a spring on its seat
  duplicate,             ///< both surfaces coincide
  inside,                ///< one lies in the solid of the other
};

/// Name in files and messages.
DISMANTLE_API std::string_view to_string(ContactClass contact);
/// Inverse of to_string(); empty for other texts.
DISMANTLE_API std::optional<ContactClass> contact_class_from_string(std::string_view text);

/// Location and kind of an overlap. Unit and frame are those of the struct that holds it.
struct OverlapPlace {
  ContactClass contact = ContactClass::local_interference;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< the deepest point
  Aabb region;                                   ///< of all surface points of one part in the other
  double share = 0;  ///< overlapping share of the nearby surfaces that face each other: [0, 1] of the area
  std::optional<Eigen::Vector3d> axis{};                 ///< unit; set for a uniform overlap around an axis
  Eigen::Vector3d axis_point = Eigen::Vector3d::Zero();  ///< point on `axis`, if set
};

}  // namespace dismantle
