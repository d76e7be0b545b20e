#include "dismantle/viewer_template.h"

#include <filesystem>
#include <system_error>

#include "dismantle/errors.h"
#include "dismantle/plan_io/read_file.h"

namespace dismantle::app {

std::optional<std::string> viewer_template() {
  namespace fs = std::filesystem;
  const fs::path file = fs::read_symlink("/proc/self/exe").parent_path() / DISMANTLE_VIEWER;
  std::error_code none;
  if (!fs::exists(file, none)) return std::nullopt;
  std::string page = read_file(file.lexically_normal());
  if (page.empty()) throw Error(file.lexically_normal().string() + " is empty");
  return page;
}

}  // namespace dismantle::app
