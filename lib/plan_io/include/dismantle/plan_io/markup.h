/// Text within HTML and XML.
#pragma once

#include <string>

#include "dismantle/export.h"

namespace dismantle {

/// `text` (UTF-8) for the content of elements and for quoted attributes. XML 1.0 does not allow control characters
/// other than line breaks and tabs: they become spaces.
DISMANTLE_API std::string escaped_markup(const std::string& text);

}  // namespace dismantle
