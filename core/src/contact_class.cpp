#include "dismantle/contact_class.h"

#include <array>
#include <utility>

namespace dismantle {

namespace {

constexpr std::array<std::pair<ContactClass, std::string_view>, 6> kContactNames{{
    {ContactClass::clearance, "clearance"},
    {ContactClass::kissing, "kissing"},
    {ContactClass::uniform_interference, "uniform_interference"},
    {ContactClass::local_interference, "local_interference"},
    {ContactClass::duplicate, "duplicate"},
    {ContactClass::inside, "inside"},
}};

}  // namespace

std::string_view to_string(ContactClass contact) {
  for (const auto& [value, name] : kContactNames)
    if (value == contact) return name;
  return "unknown";
}

std::optional<ContactClass> contact_class_from_string(std::string_view text) {
  for (const auto& [value, name] : kContactNames)
    if (name == text) return value;
  return std::nullopt;
}

}  // namespace dismantle
