/// Recognises what a part is by its name.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "dismantle/export.h"
#include "dismantle/fasteners/kinds.h"

namespace dismantle::fasteners {

/// What the name of a part or product says.
struct NameSays {
  std::optional<Kind> kind{};  ///< none: the name says nothing
  double confidence = 0;       ///< in [0, 1]
  std::string reason{};        ///< the words that say it
  std::string thread{};        ///< "M3", "1/4-20"; empty: none
  double length = 0;           ///< mm; 0: none
};

/// Reads standards (ISO, DIN, ANSI), words of several languages, and sizes: "ISO 4762 M6x20", "M5_M5 x 25", "2m6x20",
/// "#6-32 x 1/2". The last word that names a kind counts: a "motor mount plate" is a plate.
DISMANTLE_API NameSays recognise_name(std::string_view name);

}  // namespace dismantle::fasteners
