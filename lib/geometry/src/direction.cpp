#include "dismantle/geometry/direction.h"

#include <charconv>
#include <cmath>
#include <utility>

namespace dismantle {
namespace {

std::optional<double> number_in(std::string_view text) {
  const auto space = [](char c) { return c == ' '; };
  while (!text.empty() && space(text.front())) text.remove_prefix(1);
  while (!text.empty() && space(text.back())) text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Eigen::Vector3d> direction_named(std::string_view text) {
  const bool sign = text.starts_with('-') || text.starts_with('+');
  if (const std::string_view axis = text.substr(sign ? 1 : 0); axis.size() == 1 && axis[0] >= 'x' && axis[0] <= 'z')
    return (text[0] == '-' ? -1 : 1) * Eigen::Vector3d::Unit(axis[0] - 'x');
  Eigen::Vector3d out;
  for (int k = 0; k < 3; ++k) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (k == 2)) return std::nullopt;
    const std::optional<double> value = number_in(text.substr(0, comma));
    if (!value) return std::nullopt;
    out[k] = *value;
    text.remove_prefix(k == 2 ? text.size() : comma + 1);
  }
  const double length = out.stableNorm();
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return out / length;
}

}  // namespace dismantle
