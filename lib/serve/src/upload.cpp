#include "upload.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "dismantle/errors.h"

namespace dismantle::serve {
namespace {

[[noreturn]] void fail_upload(const std::string& what) {
  throw Error(fmt::format("{}: {}", what, std::generic_category().message(errno)));
}

}  // namespace

Upload::Upload(const std::filesystem::path& folder, std::size_t most) : most_(most) {
  std::string pattern = (folder / ".upload-XXXXXX").string();
  descriptor_ = ::mkstemp(pattern.data());
  if (descriptor_ < 0) fail_upload("no file can be made in the folder");
  path_ = pattern;
}

Upload::~Upload() {
  ::close(descriptor_);
  ::unlink(path_.c_str());
}

bool Upload::add(std::string_view bytes) {
  too_large_ = too_large_ || bytes.size() > most_ - size_;
  if (too_large_) return false;
  size_ += bytes.size();
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_upload("the file cannot be written");
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

bool Upload::keep_as(const std::filesystem::path& file) {
  ::fchmod(descriptor_, 0644);                                // as other files; that of mkstemp is for the user alone
  if (::link(path_.c_str(), file.c_str()) == 0) return true;  // unlike rename, never over another file
  if (errno == EEXIST) return false;
  fail_upload("the file cannot be given its name");
}

}  // namespace dismantle::serve
