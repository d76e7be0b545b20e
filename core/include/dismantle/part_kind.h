/// What a part is: a screw, a nut, a bearing.
#pragma once

#include <string>

namespace dismantle {

/// Recognised by shape and by name, or stated by the user. The words of `kind` and `size` are those of docs/plan-format.md.
struct PartKind {
  std::string kind;       ///< "screw", "nut", ...; "other" when nothing is recognised
  std::string size{};     ///< "M3x10", "6002", ...; empty: not known, or the kind has no sizes
  double confidence = 0;  ///< in [0, 1]
  std::string reason{};   ///< for people
  bool stated = false;    ///< by the user, not recognised
  bool operator==(const PartKind&) const = default;
};

}  // namespace dismantle
