/// The viewer page without a plan.
#pragma once

#include <optional>
#include <string>

namespace dismantle::app {

/// Message of a build without npm, with the remedy.
inline constexpr const char* kNoViewer =
    "this program was built without the viewer; install nodejs and npm and build again (docs/viewer.md)";

/// Reads the page from its installation path, relative to the program. Nothing if the viewer was not built.
/// @throws Error when the page exists but cannot be read.
std::optional<std::string> viewer_template();

}  // namespace dismantle::app
