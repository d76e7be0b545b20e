#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "dismantle/samples/samples.h"

namespace dismantle::samples {
namespace {

std::string obj_text(const RawPart& part) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "o {}\n", part.name);
  // Adding zero turns -0 into 0, so that mirrored parts do not differ in the sign of a zero.
  for (const auto& v : part.mesh.vertices) fmt::format_to(out, "v {} {} {}\n", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
  for (const auto& t : part.mesh.triangles) fmt::format_to(out, "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

}  // namespace

std::vector<std::filesystem::path> write(const std::vector<RawPart>& parts, const std::filesystem::path& dir) {
  std::filesystem::create_directories(dir);
  std::vector<std::filesystem::path> files;
  for (const RawPart& part : parts) {
    const auto path = dir / part.file;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    const std::string text = obj_text(part);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file)
      throw std::filesystem::filesystem_error("cannot write sample part", path,
                                              std::error_code(errno, std::generic_category()));
    files.push_back(path);
  }
  return files;
}

}  // namespace dismantle::samples
