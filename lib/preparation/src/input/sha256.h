/// Fingerprint of input files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace dismantle {

class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;
  /// Adds all bytes of `file`. @throws InputError when it cannot be read.
  void add_file(const std::filesystem::path& file);
  /// Lower-case hex. Call once.
  std::string hex();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dismantle
