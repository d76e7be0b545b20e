/// Strings of Graphviz.
#pragma once

#include <string>

namespace dismantle {

/// `text` as UTF-8, with U+FFFD in place of what is not.
std::string utf8_text(const std::string& text);

/// In quotes, for names and labels. Control characters, which have no escape, become spaces.
std::string dot_quoted(const std::string& text);

}  // namespace dismantle
