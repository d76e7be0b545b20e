// Words and standards that name kinds of parts.
#pragma once

#include <optional>
#include <string_view>

#include "dismantle/fasteners/kinds.h"

namespace dismantle::fasteners {

/// The kind that a standard's parts have; `body`: "iso" or "din". None: not a standard for one kind.
std::optional<Kind> kind_of_standard(std::string_view body, int number);

/// A word that ends the search for the kind of a token. `kind`: none for words that say that it is something else, such
/// as the holder of a screw.
struct Word {
  std::string_view text;
  std::optional<Kind> kind;
  bool whole;  ///< the token must be this word or its plural; otherwise it may end with it, as German compounds do
};
/// The word that a lower-case token is or ends with; null: none.
const Word* word_of(std::string_view token);

}  // namespace dismantle::fasteners
