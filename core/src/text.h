/// Text put together from pieces; the core has no formatting library.
#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <string>
#include <string_view>

namespace dismantle::text {

inline void append(std::string& out, std::string_view piece) { out += piece; }
inline void append(std::string& out, char piece) { out += piece; }

/// Shortest decimal that reads back as the same number, without an exponent where that is readable.
template <class Number>
  requires std::integral<Number> || std::floating_point<Number>
void append(std::string& out, Number number) {
  char digits[64];
  std::to_chars_result end{};
  if constexpr (std::floating_point<Number>) {
    const Number size = std::abs(number);
    const bool fixed = number == 0 || (size >= Number(1e-4) && size < Number(1e16));
    end = std::to_chars(digits, digits + sizeof(digits), number,
                        fixed ? std::chars_format::fixed : std::chars_format::scientific);
  } else {
    end = std::to_chars(digits, digits + sizeof(digits), number);
  }
  out.append(digits, end.ptr);
}

template <class... Pieces>
std::string join(const Pieces&... pieces) {
  std::string out;
  (append(out, pieces), ...);
  return out;
}

}  // namespace dismantle::text
