#include "input/folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "dismantle/errors.h"
#include "dismantle/preparation/read_input.h"
#include "input/own_files.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

/// Extensions of files that often lie beside meshes and hold no geometry; skipped silently.
const std::set<std::string>& companions() {
  static const std::set<std::string> set = {
      "",    "txt",  "md",  "json", "yaml", "yml",  "csv",  "xml",  "html", "pdf",  "log",  "mtl", "png",
      "jpg", "jpeg", "gif", "bmp",  "tga",  "tif",  "tiff", "webp", "svg",  "hdr",  "ktx2", "bin", "py",
      "sh",  "zip",  "gz",  "bak",  "ini",  "toml", "rst",  "dot",  "urdf", "dae~", "obj~", "stl~"};
  return set;
}

RawPart left_aside(const std::string& name, std::string problem, bool by_meaning = false) {
  RawPart out;
  out.name = valid_utf8(name);
  out.file = out.name;
  out.problem = std::move(problem);
  out.by_meaning = by_meaning;
  return out;
}

/// Whether a file that can be read lies somewhere in `folder`, outside of what this program wrote. Links to folders are
/// not followed, they may lead back.
bool holds_input(const fs::path& folder, const std::function<bool(const std::string&)>& can_read) {
  std::error_code ec;
  std::size_t seen = 0;
  const std::size_t many = 10'000;  // entries; with more, nobody waits for the answer
  for (fs::recursive_directory_iterator it(folder, ec); !ec && it != fs::recursive_directory_iterator();
       it.increment(ec)) {
    if (++seen > many) return true;
    const std::string name = it->path().filename().string();
    if (name.starts_with('.') || (it->is_directory(ec) && is_own_output(it->path()))) {
      if (it->is_directory(ec)) it.disable_recursion_pending();
    } else if (it->is_regular_file(ec) && can_read(lower_extension(it->path())) && !is_own_animation(it->path())) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::string lower_extension(const fs::path& file) {
  std::string e = file.extension().string();
  if (!e.empty()) e.erase(0, 1);
  for (char& c : e)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return e;
}

FolderContents contents_of(const fs::path& folder, const std::function<bool(const std::string&)>& can_read,
                           const std::string& readable) {
  std::error_code ec;
  std::vector<fs::path> entries;
  fs::directory_iterator it(folder, ec);
  for (; !ec && it != fs::directory_iterator(); it.increment(ec)) entries.push_back(it->path());
  if (ec) throw InputError(folder.string(), fmt::format("folder cannot be read: {}", ec.message()));
  std::sort(entries.begin(), entries.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().native(), b.filename().native());
  });
  FolderContents out;
  for (const auto& path : entries) {
    const std::string name = path.filename().string();
    if (name.empty() || name[0] == '.') continue;
    const auto status = fs::status(path, ec);
    const std::string extension = lower_extension(path);
    if (fs::is_directory(status)) {
      out.sub_folders = true;
      if (is_own_output(path) || !holds_input(path, can_read)) continue;
      out.folders.push_back(path);
      out.rest.push_back(left_aside(name + "/",
                                    "sub-folders are not read: move its files up, or plan it by its own name; "
                                    "`dismantle plan --each` plans every file and sub-folder by itself"));
    } else if (can_read(extension)) {
      // Broken links are kept, so that reading them reports the problem. Pipes and devices would hang.
      if (fs::is_other(status))
        out.rest.push_back(left_aside(name, "it is no regular file"));
      else if (extension == "glb" && is_own_animation(path))
        out.rest.push_back(left_aside(name, "it is the animation of a plan and no part", true));
      else
        out.meshes.push_back(path);
    } else if (!companions().count(extension)) {
      out.rest.push_back(
          left_aside(name, fmt::format("no importer reads '.{}' ({})", valid_utf8(extension), readable)));
    }
  }
  return out;
}

}  // namespace dismantle
