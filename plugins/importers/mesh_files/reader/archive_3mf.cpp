#include "archive_3mf.h"

#include <fmt/format.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <vector>

#include "dismantle/errors.h"

namespace dismantle::mesh_files {
namespace {

/// XML of meshes shrinks to a tenth. What shrinks to a hundredth was made to fill the memory.
constexpr std::uint64_t kSmall = std::uint64_t{64} << 20, kLargest = std::uint64_t{4} << 30, kRatio = 100;

const int kNoCase = 2;

}  // namespace

Archive3mf::Archive3mf(const std::filesystem::path& file) : file_(file), handle_(unzOpen64(file.c_str())) {
  if (handle_ == nullptr) fail("this is no 3mf file, or it is cut off: no zip archive");
}

Archive3mf::~Archive3mf() {
  if (handle_ != nullptr) unzClose(handle_);
}

void Archive3mf::fail(const std::string& problem) const { throw InputError(file_.string(), problem); }

bool Archive3mf::holds(const std::string& name) const {
  return unzLocateFile(handle_, name.c_str(), kNoCase) == UNZ_OK;
}

void Archive3mf::read(const std::string& name, const std::function<void(std::string_view)>& take) {
  unz_file_info64 info{};
  if (!holds(name) || unzGetCurrentFileInfo64(handle_, &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
    fail(fmt::format("'{}' is not in the archive", name));
  const auto check = [&](std::uint64_t size) {
    if (size > kLargest || (size > kSmall && size > kRatio * (info.compressed_size + 1)))
      fail(fmt::format("'{}' in the archive expands from {} to more than {} bytes: refused", name, info.compressed_size,
                       std::min(size, kLargest)));
  };
  check(info.uncompressed_size);
  if ((info.flag & 1) != 0) fail(fmt::format("'{}' in the archive is encrypted", name));
  if (unzOpenCurrentFile(handle_) != UNZ_OK)
    fail(fmt::format("'{}' in the archive cannot be read: its compression is not known", name));
  std::vector<char> block(1 << 16);
  std::uint64_t size = 0;
  int n = 0;
  while ((n = unzReadCurrentFile(handle_, block.data(), static_cast<unsigned>(block.size()))) > 0) {
    size += static_cast<std::uint64_t>(n);
    expanded_ += static_cast<std::uint64_t>(n);
    check(size);
    if (expanded_ > kLargest) fail("the files in the archive expand beyond 4 GiB: refused");
    take({block.data(), static_cast<std::size_t>(n)});
  }
  if (n < 0 || unzCloseCurrentFile(handle_) != UNZ_OK)
    fail(fmt::format("'{}' in the archive is damaged: its content does not agree with its checksum", name));
}

}  // namespace dismantle::mesh_files
