/// `dismantle plugins new`: a project for a plugin out of tree, from the templates that are installed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dismantle::app {

/// Kinds of plugin that there is a template for, as a configuration names them.
std::vector<std::string> template_kinds();

/// Writes a project for a plugin `id` of this kind to `folder`, which is made when it is not there.
/// Returns the files, relative to `folder`, in alphabetical order.
/// @throws Error: unknown kind, an id that is not words joined by dots, a folder that holds something, templates that
/// are not installed, a file that cannot be written.
std::vector<std::string> write_plugin_project(const std::filesystem::path& folder, const std::string& kind,
                                              const std::string& id);

}  // namespace dismantle::app
