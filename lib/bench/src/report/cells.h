/// Cells of tables.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "dismantle/bench/report.h"

namespace dismantle::bench {

inline TableCell number(double value, const char* format = "{:.3g}") {
  return {fmt::format(fmt::runtime(format), value), value};
}
inline TableCell whole(std::size_t value) { return {std::to_string(value), double(value)}; }
inline TableCell text(const std::string& value) { return {value, std::nullopt}; }

}  // namespace dismantle::bench
