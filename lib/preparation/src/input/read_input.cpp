#include "dismantle/preparation/read_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "dismantle/errors.h"
#include "dismantle/preparation/sha256.h"
#include "dismantle/referenced_file.h"
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

std::string lower_extension(const fs::path& file) {
  std::string e = file.extension().string();
  if (!e.empty()) e.erase(0, 1);
  for (char& c : e)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return e;
}

using Readers = std::map<std::string, std::shared_ptr<Importer>>;

Readers readers_of(const std::vector<std::shared_ptr<Importer>>& importers) {
  Readers readers;
  for (const auto& importer : importers)
    for (const auto& extension : importer->extensions()) readers.emplace(extension, importer);  // the first one wins
  return readers;
}

std::string readable(const Readers& readers) {
  if (readers.empty()) return "no importer is loaded";
  std::string list;
  for (const auto& [extension, importer] : readers) list += (list.empty() ? "." : ", .") + extension;
  return "can be read: " + list;
}

/// Files of `folder` that are meshes, in natural order; says in `warnings` what else looks like geometry.
std::vector<fs::path> meshes_in(const fs::path& folder, const Readers& readers, std::vector<std::string>& warnings) {
  std::error_code ec;
  std::vector<fs::path> entries;
  fs::directory_iterator it(folder, ec);
  for (; !ec && it != fs::directory_iterator(); it.increment(ec)) entries.push_back(it->path());
  if (ec) throw InputError(folder.string(), fmt::format("folder cannot be read: {}", ec.message()));
  std::sort(entries.begin(), entries.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().native(), b.filename().native());
  });
  std::vector<fs::path> meshes;
  std::vector<std::string> folders;
  for (const auto& path : entries) {
    const std::string name = path.filename().string();
    if (name.empty() || name[0] == '.') continue;
    const auto status = fs::status(path, ec);
    const std::string extension = lower_extension(path);
    if (fs::is_directory(status)) {
      folders.push_back(valid_utf8(name));
    } else if (readers.count(extension)) {
      // Broken links are kept, so that reading them reports the problem. Pipes and devices would hang.
      if (fs::is_other(status))
        warnings.push_back(fmt::format("'{}' is no regular file: left aside", valid_utf8(name)));
      else if (extension == "glb" && is_own_animation(path))
        warnings.push_back(fmt::format("'{}' is the animation of a plan and no part: left aside", valid_utf8(name)));
      else
        meshes.push_back(path);
    } else if (!companions().count(extension)) {
      warnings.push_back(
          fmt::format("'{}' left aside: no importer reads '.{}' ({})", valid_utf8(name), extension, readable(readers)));
    }
  }
  if (!folders.empty())
    warnings.push_back(
        fmt::format("sub-folders are not read: {} of them, the first is '{}'", folders.size(), folders.front()));
  if (meshes.empty())
    throw InputError(folder.string(), fmt::format("no mesh file in this folder ({}){}", readable(readers),
                                                  folders.empty() ? "" : "; sub-folders are not read"));
  return meshes;
}

/// Files next to a glTF text file that hold its geometry.
std::vector<fs::path> buffers_of_gltf(const fs::path& file) {
  std::vector<fs::path> buffers;
  std::FILE* in = std::fopen(file.c_str(), "rb");
  if (!in) return buffers;  // reading the file itself reports that
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  std::fclose(in);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return buffers;
  for (const auto& buffer : json["buffers"]) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const auto uri = buffer["uri"].get<std::string>();
    if (uri.rfind("data:", 0) == 0) continue;
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
      unsigned code = 0;
      if (uri[i] == '%' && i + 2 < uri.size() && std::sscanf(uri.c_str() + i + 1, "%2x", &code) == 1) {
        name += static_cast<char>(code);
        i += 2;
      } else {
        name += uri[i];
      }
    }
    const fs::path path = file.parent_path() / name;
    if (may_read_referenced(path, file)) buffers.push_back(path);
  }
  return buffers;
}

std::string too_many(std::uint64_t count, const std::string& where, std::int64_t limit) {
  return fmt::format(
      "{} triangles{} are more than the limit of {} (assembly.max_triangles): simplify the meshes or raise the limit",
      count, where, limit);
}

/// Thrown above the limit of triangles; refuses the whole input.
class TooLarge : public InputError {
 public:
  using InputError::InputError;
};

class Reader {
 public:
  Reader(const ReadOptions& options, const RunContext& context, InputParts& out)
      : options_(options), context_(context), out_(out) {}

  /// All parts of one file, checked; adds its bytes to the fingerprint.
  std::vector<RawPart> read(const fs::path& file, Importer& importer) {
    stop_if_told(file);
    std::error_code ec;
    const auto bytes = fs::file_size(file, ec);
    if (ec) throw InputError(file.string(), fmt::format("cannot be read: {}", ec.message()));
    if (bytes == 0) throw InputError(file.string(), "the file is empty");
    // No format takes less than four bytes a triangle.
    if (bytes / 4 > static_cast<std::uint64_t>(options_.max_triangles)) {
      const auto count = importer.count_triangles(file);
      if (count && *count > static_cast<std::uint64_t>(options_.max_triangles))
        throw TooLarge(file.string(), too_many(*count, "", options_.max_triangles));
    }
    hash_.add_file(file);
    if (lower_extension(file) == "gltf")
      for (const auto& buffer : buffers_of_gltf(file)) hash_.add_file(buffer);
    std::vector<RawPart> parts = importer.read(file, context_);
    stop_if_told(file);
    if (parts.empty()) throw InputError(file.string(), "the file holds no mesh");
    for (auto& part : parts) {
      total_ += part.mesh.triangles.size();
      part.name = valid_utf8(part.name);
      part.file = valid_utf8(file.filename().string());
      for (auto& parent : part.parents) parent = valid_utf8(parent);
    }
    return parts;
  }

  /// One file of a folder. An unreadable file becomes an unusable part.
  RawPart read_whole(const fs::path& file, Importer& importer) {
    try {
      return joined(read(file, importer), file);
    } catch (const TooLarge&) {
      throw;
    } catch (const InputError& e) {
      RawPart broken;
      broken.file = valid_utf8(file.filename().string());
      broken.problem = e.what();
      // The subject is the file, which the part's name already tells.
      if (const std::string subject = e.subject() + ": "; broken.problem.starts_with(subject))
        broken.problem.erase(0, subject.size());
      broken.problem = fmt::format("{} cannot be read: {}", broken.file, valid_utf8(broken.problem));
      return broken;
    }
  }

  void add_folder(const fs::path& folder, const Readers& readers) {
    const auto files = meshes_in(folder, readers, out_.warnings);
    std::map<std::string, int> stems;
    for (const auto& file : files) ++stems[valid_utf8(file.stem().string())];
    std::size_t done = 0;
    for (const auto& file : files) {
      context_.progress("read", done++, files.size(), file.filename().string());
      RawPart whole = read_whole(file, *readers.at(lower_extension(file)));
      check_total(file);
      whole.name = valid_utf8(file.stem().string());
      if (stems[whole.name] > 1) {
        out_.warnings.push_back(
            fmt::format("several files are called '{}': this one is part '{}'", whole.name, whole.file));
        whole.name = whole.file;
      }
      out_.parts.push_back(std::move(whole));
    }
    context_.progress("read", done, files.size());
  }

  void add_file(const fs::path& file, const Readers& readers) {
    const auto found = readers.find(lower_extension(file));
    if (found == readers.end())
      throw InputError(file.string(), fmt::format("no importer reads files with the ending '{}' ({})",
                                                  file.extension().string(), readable(readers)));
    context_.progress("read", 0, 1, file.filename().string());
    out_.parts = read(file, *found->second);
    check_total(file);
    for (auto& part : out_.parts)
      if (part.name.empty()) part.name = valid_utf8(file.stem().string());
    context_.progress("read", 1, 1);
  }

  std::string fingerprint() { return hash_.hex(); }

 private:
  void stop_if_told(const fs::path& file) const {
    if (context_.should_stop()) throw Error("stopped while reading " + file.string());
  }

  void check_total(const fs::path& file) const {
    if (total_ > static_cast<std::uint64_t>(options_.max_triangles))
      throw TooLarge(file.string(), too_many(total_, " up to this file", options_.max_triangles));
  }

  /// All bodies of a file as one part; those that cannot be used are named in a warning, unless there are no others.
  RawPart joined(std::vector<RawPart> parts, const fs::path& file) {
    RawPart whole;
    whole.file = parts.front().file;
    bool first = true;
    for (auto& part : parts) {
      if (!part.problem.empty()) {
        if (whole.problem.empty()) whole.problem = part.problem;
        out_.warnings.push_back(
            fmt::format("'{}' of {} is left aside: {}", part.name, valid_utf8(file.filename().string()), part.problem));
        continue;
      }
      if (first) {
        whole.colour = part.colour;
        whole.unit = part.unit;
        whole.mesh = std::move(part.mesh);
        first = false;
        continue;
      }
      if (whole.colour != part.colour) whole.colour.reset();  // there is no one colour for all
      append(whole.mesh, part.mesh);
    }
    if (!first) whole.problem.clear();
    return whole;
  }

  static void append(Mesh& to, const Mesh& from) {
    const auto base = static_cast<std::uint32_t>(to.vertices.size());
    to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
    for (const auto& t : from.triangles) to.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }

  const ReadOptions& options_;
  const RunContext& context_;
  InputParts& out_;
  Sha256 hash_;
  std::uint64_t total_ = 0;
};

}  // namespace

InputParts read_input(const fs::path& input, const std::vector<std::shared_ptr<Importer>>& importers,
                      const ReadOptions& options, const RunContext& context) {
  if (input.empty()) throw InputError("", "no input was named");
  std::error_code ec;
  const auto status = fs::status(input, ec);
  if (status.type() == fs::file_type::not_found) throw InputError(input.string(), "there is no such file or folder");
  if (ec) throw InputError(input.string(), fmt::format("cannot be read: {}", ec.message()));
  InputParts out;
  const Readers readers = readers_of(importers);
  Reader reader(options, context, out);
  if (fs::is_directory(status))
    reader.add_folder(input, readers);
  else if (fs::is_regular_file(status))
    reader.add_file(input, readers);
  else
    throw InputError(input.string(), "this is neither a regular file nor a folder");
  make_names_unique(out.parts, out.warnings);
  out.sha256 = reader.fingerprint();
  return out;
}

}  // namespace dismantle
