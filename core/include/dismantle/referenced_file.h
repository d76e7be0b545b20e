/// Files that an input file refers to by name: textures, materials, buffers.
#pragma once

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace dismantle {

/// May `named` be read because the untrusted `file` refers to it? Only if it is a regular file in the folder of `file`
/// or below, after `..` and links are resolved: a model from elsewhere must not read other files of the user.
inline bool may_read_referenced(const std::filesystem::path& named, const std::filesystem::path& file) {
  std::error_code problem;
  if (!std::filesystem::is_regular_file(named, problem)) return false;  // pipes and devices would hang
  const std::filesystem::path there = std::filesystem::canonical(named, problem);
  if (problem) return false;
  const std::filesystem::path parent = file.parent_path();
  const std::filesystem::path folder = std::filesystem::canonical(parent.empty() ? "." : parent, problem);
  if (problem) return false;
  return std::mismatch(folder.begin(), folder.end(), there.begin(), there.end()).first == folder.end();
}

}  // namespace dismantle
