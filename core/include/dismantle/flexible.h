/// Parts that bend: others may cut into them as deep as they are thick.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dismantle {

/// Why a part counts as flexible (docs/concepts.md).
enum class Flexible {
  declared,  ///< the user says so
  coil,      ///< its shape and its contact: a wire of one section that coils, as a spring does
  loop,      ///< its shape and its contact: a closed round strand, as an O-ring or a round belt
};

inline constexpr std::array<std::string_view, 3> kFlexibleNames{"declared", "coil", "loop"};  ///< by Flexible
/// The word that files and messages use.
constexpr std::string_view to_string(Flexible flexible) {
  return kFlexibleNames.at(static_cast<std::size_t>(flexible));
}
/// The kind of that word; nothing for other words.
constexpr std::optional<Flexible> flexible_from_string(std::string_view text) {
  for (std::size_t i = 0; i < kFlexibleNames.size(); ++i)
    if (kFlexibleNames[i] == text) return static_cast<Flexible>(i);
  return std::nullopt;
}

/// A part that counts as flexible.
struct FlexiblePart {
  std::string part;
  Flexible kind = Flexible::declared;
  double depth = 0;                   ///< to which it may be cut into, assembly units
  std::vector<std::string> others{};  ///< recognised: those that may cut into it; declared: all may
};

}  // namespace dismantle
