/// A file on its way into the folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace dismantle::serve {

/// A hidden file beside its place, removed again unless it is kept.
class Upload {
 public:
  /// @throws Error when it cannot be made.
  Upload(const std::filesystem::path& folder, std::size_t most);
  ~Upload();
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  /// False when it would be larger than allowed. @throws Error when it cannot be written.
  bool add(std::string_view bytes);
  bool too_large() const { return too_large_; }
  /// Gives it its name. False: there is something of that name already. @throws Error.
  bool keep_as(const std::filesystem::path& file);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::size_t most_, size_ = 0;
  bool too_large_ = false;
};

}  // namespace dismantle::serve
