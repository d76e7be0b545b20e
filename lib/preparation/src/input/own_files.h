/// Files that this program wrote itself and that lie among its input.
#pragma once

#include <filesystem>

namespace dismantle {

/// Whether `file` is an animation of a plan (plan.glb, under whatever name): it shows the parts and is not one.
bool is_own_animation(const std::filesystem::path& file);

/// Whether `dismantle prepare` wrote its meshes to `folder`.
bool is_own_output(const std::filesystem::path& folder);

}  // namespace dismantle
