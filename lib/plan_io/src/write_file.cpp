#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "dismantle/errors.h"
#include "dismantle/plan_io/write_file.h"

namespace dismantle {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  throw Error(fmt::format("{}: cannot write: {}", file.string(), std::generic_category().message(error)));
}

/// Flushes the new name to disk. File systems whose folders cannot be synchronised do this themselves.
void sync_folder(const std::filesystem::path& folder) {
  const int fd = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

}  // namespace

void write_file(const std::filesystem::path& file, const std::string& content) {
  // The process id keeps two runs that write to one folder from sharing a temporary file.
  std::filesystem::path temporary = file;
  temporary.replace_filename(fmt::format(".{}.{}.tmp", file.filename().string(), ::getpid()));

  const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) fail(file, errno);
  int error = 0;
  for (std::size_t done = 0; done < content.size() && error == 0;) {
    const ssize_t n = ::write(fd, content.data() + done, content.size() - done);
    if (n >= 0)
      done += static_cast<std::size_t>(n);
    else if (errno != EINTR)
      error = errno;
  }
  // Without this a file may have its name before its bytes are on the disk.
  while (error == 0 && ::fsync(fd) != 0)
    if (errno != EINTR) error = errno;
  if (::close(fd) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    fail(file, error);
  }
  sync_folder(file.parent_path());
}

}  // namespace dismantle
