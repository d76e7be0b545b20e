#include "dismantle/viewer_template.h"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "dismantle/errors.h"

namespace dismantle::app {

std::optional<std::string> viewer_template() {
  namespace fs = std::filesystem;
  const fs::path file = fs::read_symlink("/proc/self/exe").parent_path() / DISMANTLE_VIEWER;
  std::error_code none;
  if (!fs::exists(file, none)) return std::nullopt;
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in.is_open() || in.bad() || !text || text.view().empty())
    throw Error(file.lexically_normal().string() + " cannot be read: " + std::generic_category().message(errno));
  return std::move(text).str();
}

}  // namespace dismantle::app
