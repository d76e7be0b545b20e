/// Kinds of parts and drives of fasteners.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace dismantle::fasteners {

/// What a part is (docs/fasteners.md).
enum class Kind {
  screw,  ///< a bolt is the same kind
  nut,
  washer,
  spacer,
  standoff,
  pin,
  ring,  ///< circlip, O-ring
  collar,
  coupling,
  bearing,
  gear,
  pulley,
  wheel,
  spring,
  belt,
  shaft,
  rail,
  insert,
  motor,
  board,
  plate,
  housing,
  other,  ///< nothing is recognised
};

inline constexpr std::array<std::string_view, 23> kKindNames{
    "screw",    "nut",     "washer", "spacer", "stand-off", "pin",     "ring", "collar",
    "coupling", "bearing", "gear",   "pulley", "wheel",     "spring",  "belt", "shaft",
    "rail",     "insert",  "motor",  "board",  "plate",     "housing", "other"};  ///< by Kind
/// Name in files and messages.
constexpr std::string_view to_string(Kind kind) { return kKindNames.at(static_cast<std::size_t>(kind)); }
/// Inverse of to_string(); "bolt" is a screw. Empty for other texts.
constexpr std::optional<Kind> kind_from_string(std::string_view text) {
  if (text == "bolt") return Kind::screw;
  if (text == "standoff") return Kind::standoff;
  for (std::size_t i = 0; i < kKindNames.size(); ++i)
    if (kKindNames[i] == text) return static_cast<Kind>(i);
  return std::nullopt;
}

/// Where a tool takes hold of a fastener.
enum class Drive { none, hex_socket, torx, cross, slot, square, outer_hex, knurl };

inline constexpr std::array<std::string_view, 8> kDriveNames{"none", "hex socket", "torx",      "cross",
                                                             "slot", "square",     "outer hex", "knurl"};  ///< by Drive
/// Name in files and messages.
constexpr std::string_view to_string(Drive drive) { return kDriveNames.at(static_cast<std::size_t>(drive)); }

}  // namespace dismantle::fasteners
