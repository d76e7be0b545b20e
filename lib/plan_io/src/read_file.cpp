#include "dismantle/plan_io/read_file.h"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include "dismantle/errors.h"

namespace dismantle {

std::string read_file(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) throw InputError(file.string(), "cannot be read: it is a folder");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
  if (!in.is_open() || in.bad() || text.bad())
    throw InputError(file.string(), "cannot be read: " + std::generic_category().message(errno));
  return std::move(text).str();
}

}  // namespace dismantle
