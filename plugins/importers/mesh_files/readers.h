/// One reader per format. Each throws InputError naming the file and, for text, the line; Error when the context wants
/// to stop.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "dismantle/importer.h"

namespace dismantle::mesh_files {

/// Objects are parts; a file without objects has its groups as parts, one without groups is one part without name.
std::vector<RawPart> read_obj(const std::filesystem::path& file, const RunContext& context = {});
/// Fans count as their triangles. Nothing when the file cannot be read.
std::optional<std::uint64_t> count_obj_triangles(const std::filesystem::path& file);

/// Text or binary, told apart by the size that a binary file states. Each `solid` of a text file is a part.
std::vector<RawPart> read_stl(const std::filesystem::path& file, const RunContext& context = {});
std::optional<std::uint64_t> count_stl_triangles(const std::filesystem::path& file);

/// Text only; OFF, with or without counts on the first line, COFF and NOFF (colours and normals are left out).
std::vector<RawPart> read_off(const std::filesystem::path& file, const RunContext& context = {});

/// Text and binary of both byte orders.
std::vector<RawPart> read_ply(const std::filesystem::path& file, const RunContext& context = {});
/// As the header states; polygons count as one.
std::optional<std::uint64_t> count_ply_triangles(const std::filesystem::path& file);

}  // namespace dismantle::mesh_files
