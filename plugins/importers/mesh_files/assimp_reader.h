/// The reader that needs assimp, in a library of its own: loading assimp takes longer than reading most folders of
/// meshes.
#pragma once

#include <filesystem>
#include <vector>

#include "dismantle/importer.h"

/// What the library exports: read_with_assimp() of readers.h. @throws as that.
extern "C" __attribute__((visibility("default"))) void dismantle_read_scene(const std::filesystem::path& file,
                                                                            const dismantle::RunContext& context,
                                                                            std::vector<dismantle::RawPart>& parts);
