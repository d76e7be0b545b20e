/// One reader per format. Each throws InputError with the file and, for text, the line; and Error when the context
/// requests a stop.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "dismantle/importer.h"

namespace dismantle::mesh_files {

/// Each object is a part; without objects each group; without groups the file is one part without a name.
std::vector<RawPart> read_obj(const std::filesystem::path& file, const RunContext& context = {});
/// Polygons count as their triangles. Nothing when the file cannot be read.
std::optional<std::uint64_t> count_obj_triangles(const std::filesystem::path& file);

/// Text or binary, distinguished by the size that a binary file states. Each `solid` of a text file is a part.
std::vector<RawPart> read_stl(const std::filesystem::path& file, const RunContext& context = {});
std::optional<std::uint64_t> count_stl_triangles(const std::filesystem::path& file);

/// Text only: OFF, with or without counts on the first line, COFF and NOFF (colours and normals are ignored).
std::vector<RawPart> read_off(const std::filesystem::path& file, const RunContext& context = {});

/// Text, and binary in both byte orders.
std::vector<RawPart> read_ply(const std::filesystem::path& file, const RunContext& context = {});
/// Number of faces in the header; a polygon counts as one.
std::optional<std::uint64_t> count_ply_triangles(const std::filesystem::path& file);

}  // namespace dismantle::mesh_files
