/// `dismantle plugins new`: creates a project for an out-of-tree plugin from the installed templates.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dismantle::app {

/// Kinds of plugin that have a template, named as in configurations.
std::vector<std::string> template_kinds();

/// Writes a project for a plugin `id` of this kind to `folder`, which is created if needed.
/// Returns the files, relative to `folder`, in alphabetical order.
/// @throws Error for an unknown kind, an id that is not words joined by dots, a folder that is not empty, templates
/// that are not installed, or a file that cannot be written.
std::vector<std::string> write_plugin_project(const std::filesystem::path& folder, const std::string& kind,
                                              const std::string& id);

}  // namespace dismantle::app
