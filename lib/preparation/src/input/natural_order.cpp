#include <cstddef>

#include "dismantle/preparation/read_input.h"

namespace dismantle {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// End of the run of digits that starts at `i`.
std::size_t end_of_digits(std::string_view s, std::size_t i) {
  while (i < s.size() && is_digit(s[i])) ++i;
  return i;
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::size_t ie = end_of_digits(a, i), je = end_of_digits(b, j);
      while (i + 1 < ie && a[i] == '0') ++i;
      while (j + 1 < je && b[j] == '0') ++j;
      if (ie - i != je - j) return ie - i < je - j;
      const int order = a.substr(i, ie - i).compare(b.substr(j, je - j));
      if (order != 0) return order < 0;
      i = ie;
      j = je;
    } else {
      if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
      ++i;
      ++j;
    }
  }
  if (i < a.size() || j < b.size()) return i >= a.size();
  return a < b;  // "1" and "01": equal as numbers, so bytewise
}

}  // namespace dismantle
