/// The page that shows plans, without a plan in it.
#pragma once

#include <optional>
#include <string>

namespace dismantle::app {

/// What a build without npm says, and what helps.
inline constexpr const char* kNoViewer =
    "this program was built without the viewer; install nodejs and npm and build again (docs/viewer.md)";

/// Read from where it is installed, seen from the program. Nothing if the viewer was not built.
/// @throws Error when it is there and cannot be read.
std::optional<std::string> viewer_template();

}  // namespace dismantle::app
