/// SHA-256: fingerprints of files, plugins and attempts.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "dismantle/export.h"

namespace dismantle {

/// The 32 bytes of a digest.
using Sha256Digest = std::array<unsigned char, 32>;

/// Of bytes that come piece by piece. All functions throw Error when OpenSSL has no SHA-256.
class DISMANTLE_API Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::string_view bytes);
  /// Adds all bytes of `file`. @throws InputError when it cannot be read.
  void add_file(const std::filesystem::path& file);
  /// Call once.
  Sha256Digest digest();
  /// The digest as 64 lower-case hexadecimal digits. Call once.
  std::string hex();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Sha256::hex() of a file's bytes. @throws InputError when it cannot be read.
DISMANTLE_API std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace dismantle
