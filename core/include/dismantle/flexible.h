/// Flexible parts: other parts may cut into them up to their thickness.
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
  coil,      ///< recognised by shape and contact: a coiled wire of one section, such as a spring
  loop,      ///< recognised by shape and contact: a closed round strand, such as an O-ring or a round belt
  material,  ///< the file says that its material bends, such as rubber
};

inline constexpr std::array<std::string_view, 4> kFlexibleNames{"declared", "coil", "loop", "material"};  ///< by Flexible
/// Name in files and messages.
constexpr std::string_view to_string(Flexible flexible) {
  return kFlexibleNames.at(static_cast<std::size_t>(flexible));
}
/// Inverse of to_string(); empty for other texts.
constexpr std::optional<Flexible> flexible_from_string(std::string_view text) {
  for (std::size_t i = 0; i < kFlexibleNames.size(); ++i)
    if (kFlexibleNames[i] == text) return static_cast<Flexible>(i);
  return std::nullopt;
}

/// A part that counts as flexible.
struct FlexiblePart {
  std::string part;
  Flexible kind = Flexible::declared;
  double depth = 0;                   ///< how deep other parts may cut into it; assembly units
  std::vector<std::string> others{};  ///< parts that may cut into it; empty: it is declared by the user, all may
};

}  // namespace dismantle
