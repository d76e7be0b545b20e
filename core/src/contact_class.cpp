#include "dismantle/contact_class.h"

#include <array>

namespace dismantle {

constexpr std::array<std::string_view, 6> kContactNames{"clearance",          "kissing",   "uniform_interference",
                                                        "local_interference", "duplicate", "inside"};

std::string_view to_string(ContactClass contact) { return kContactNames.at(static_cast<std::size_t>(contact)); }

std::optional<ContactClass> contact_class_from_string(std::string_view text) {
  for (std::size_t i = 0; i < kContactNames.size(); ++i)
    if (kContactNames[i] == text) return static_cast<ContactClass>(i);
  return std::nullopt;
}

}  // namespace dismantle
