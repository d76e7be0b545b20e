/// The bytes of one trial as a file, for readers that take a path.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

namespace dismantle::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// A folder of this process in memory, as far as the machine has one; removed at exit.
inline const std::filesystem::path& scratch_folder() {
  static const std::filesystem::path folder = [] {
    std::error_code none;
    const std::filesystem::path memory = "/dev/shm";
    const auto base = std::filesystem::is_directory(memory, none) ? memory : std::filesystem::temp_directory_path();
    auto made = base / ("dismantle_fuzz_" + std::to_string(::getpid()));
    std::filesystem::create_directories(made);
    std::atexit([] {
      std::error_code ignored;
      std::filesystem::remove_all(scratch_folder(), ignored);
    });
    return made;
  }();
  return folder;
}

/// Replaces the file of that name.
inline std::filesystem::path input_file(const std::string& name, Bytes bytes) {
  const auto file = scratch_folder() / name;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) std::abort();  // the trial would mean nothing
  return file;
}

}  // namespace dismantle::fuzz
