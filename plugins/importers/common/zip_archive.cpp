#include "zip_archive.h"

#include <fmt/format.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <system_error>

#include "dismantle/errors.h"

namespace dismantle::reader_process {
namespace {

constexpr std::uint64_t kSmall = std::uint64_t{64} << 20, kLargest = std::uint64_t{4} << 30, kRatio = 100;

const int kNoCase = 2;

}  // namespace

std::string expands_too_much(std::uint64_t compressed, std::uint64_t expanded) {
  if (expanded <= kLargest && (expanded <= kSmall || expanded <= kRatio * (compressed + 1))) return {};
  return fmt::format("expands from {} to more than {} bytes: refused", compressed, std::min(expanded, kLargest));
}

ZipArchive::ZipArchive(const std::filesystem::path& file, const std::string& what)
    : file_(file), handle_(unzOpen64(file.c_str())) {
  std::error_code ec;
  size_ = std::filesystem::file_size(file, ec);
  if (handle_ == nullptr) fail(fmt::format("this is no {}, or it is cut off: no zip archive", what));
}

ZipArchive::~ZipArchive() {
  if (handle_ != nullptr) unzClose(handle_);
}

void ZipArchive::fail(const std::string& problem) const { throw InputError(file_.string(), problem); }

std::vector<std::string> ZipArchive::names() {
  std::vector<std::string> out;
  std::vector<char> name(1 << 16);
  for (int at = unzGoToFirstFile(handle_); at == UNZ_OK; at = unzGoToNextFile(handle_)) {
    if (unzGetCurrentFileInfo64(handle_, nullptr, name.data(), name.size() - 1, nullptr, 0, nullptr, 0) != UNZ_OK)
      fail("the list of files of the archive is damaged");
    out.emplace_back(name.data());
  }
  return out;
}

bool ZipArchive::holds(const std::string& name) const {
  return unzLocateFile(handle_, name.c_str(), kNoCase) == UNZ_OK;
}

void ZipArchive::read(const std::string& name, const std::function<void(std::string_view)>& take) {
  unz_file_info64 info{};
  if (!holds(name) || unzGetCurrentFileInfo64(handle_, &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
    fail(fmt::format("'{}' is not in the archive", name));
  const auto check = [&](std::uint64_t size) {
    // What the archive says of itself may be wrong.
    if (const std::string problem = expands_too_much(std::min<std::uint64_t>(info.compressed_size, size_), size);
        !problem.empty())
      fail(fmt::format("'{}' in the archive {}", name, problem));
  };
  check(info.uncompressed_size);
  if (info.compression_method != 0 && info.compression_method != Z_DEFLATED)
    fail(fmt::format("'{}' in the archive is compressed in a way that is not read (method {})", name,
                     info.compression_method));
  if ((info.flag & 1) != 0) fail(fmt::format("'{}' in the archive is encrypted", name));
  if (unzOpenCurrentFile(handle_) != UNZ_OK)
    fail(fmt::format("'{}' in the archive is damaged: its two headers do not agree", name));
  std::vector<char> block(1 << 16);
  std::uint64_t size = 0;
  int n = 0;
  while ((n = unzReadCurrentFile(handle_, block.data(), static_cast<unsigned>(block.size()))) > 0) {
    size += static_cast<std::uint64_t>(n);
    expanded_ += static_cast<std::uint64_t>(n);
    check(size);
    if (const std::string problem = expands_too_much(size_, expanded_); !problem.empty())
      fail("the archive " + problem);
    take({block.data(), static_cast<std::size_t>(n)});
  }
  if (n < 0 || unzCloseCurrentFile(handle_) != UNZ_OK)
    fail(fmt::format("'{}' in the archive is damaged: its content does not agree with its checksum", name));
}

}  // namespace dismantle::reader_process
