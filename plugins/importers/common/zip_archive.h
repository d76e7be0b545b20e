/// The files in a zip archive, and the limits of all compressed input.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace dismantle::reader_process {

/// Text of meshes and STEP shrinks to a tenth. What shrinks to a hundredth was made to fill the memory.
/// @returns the reason to refuse it, or "".
std::string expands_too_much(std::uint64_t compressed, std::uint64_t expanded);

/// A zip archive that may lie about its content. Names are compared without regard to case, as OPC has it.
class ZipArchive {
 public:
  /// @throws InputError when it is no zip archive: "this is no `what`, or ...".
  ZipArchive(const std::filesystem::path& file, const std::string& what);
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  std::vector<std::string> names();
  bool holds(const std::string& name) const;
  /// Passes the content of `name` to `take`, piece by piece. @throws InputError for damaged content, and for an archive
  /// that expands beyond all reason.
  void read(const std::string& name, const std::function<void(std::string_view)>& take);

 private:
  [[noreturn]] void fail(const std::string& problem) const;

  std::filesystem::path file_;
  void* handle_ = nullptr;
  std::uint64_t size_ = 0, expanded_ = 0;  // bytes, of the file and of all that was read
};

}  // namespace dismantle::reader_process
