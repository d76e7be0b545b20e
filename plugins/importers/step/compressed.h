/// Compressed STEP files (.stpz): one STEP file, compressed by gzip, or in a zip archive.
#pragma once

#include <filesystem>
#include <string>

namespace dismantle::step_import {

/// By the first bytes, whatever the name.
bool is_compressed(const std::filesystem::path& file);

/// The text of the STEP file in it. @throws InputError when it is damaged, holds no or several STEP files, or expands
/// beyond all reason.
std::string unpacked(const std::filesystem::path& file);

}  // namespace dismantle::step_import
