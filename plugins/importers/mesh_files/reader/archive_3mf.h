/// The files in a 3MF archive.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace dismantle::mesh_files {

/// A zip archive that may lie about its content. Names are compared without regard to case, as OPC has it.
class Archive3mf {
 public:
  /// @throws InputError when it is no zip archive.
  explicit Archive3mf(const std::filesystem::path& file);
  ~Archive3mf();
  Archive3mf(const Archive3mf&) = delete;
  Archive3mf& operator=(const Archive3mf&) = delete;

  bool holds(const std::string& name) const;
  /// Passes the content of `name` to `take`, piece by piece. @throws InputError for damaged content, and for an archive
  /// that expands beyond all reason.
  void read(const std::string& name, const std::function<void(std::string_view)>& take);

 private:
  [[noreturn]] void fail(const std::string& problem) const;

  std::filesystem::path file_;
  void* handle_ = nullptr;
  std::uint64_t expanded_ = 0;  // bytes, of all that was read
};

}  // namespace dismantle::mesh_files
