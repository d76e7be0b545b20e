#include "mesh_files.h"

#include <fmt/format.h>

#include <new>

#include "assimp_reader.h"
#include "dismantle/errors.h"
#include "dismantle/plugin/late_library.h"
#include "readers.h"

namespace dismantle::mesh_files {
namespace {

std::string ending(const std::filesystem::path& file) {
  std::string e = file.extension().string();
  if (!e.empty()) e.erase(0, 1);
  for (char& c : e)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return e;
}

}  // namespace

std::vector<RawPart> read_with_assimp(const std::filesystem::path& file, const RunContext& context) {
  std::vector<RawPart> parts;
  late_function<decltype(dismantle_read_scene)>(DISMANTLE_ASSIMP_READER, "dismantle_read_scene")(file, context, parts);
  return parts;
}

std::vector<std::string> MeshFiles::extensions() const {
  return {"obj", "stl", "off", "ply", "glb", "gltf", "3mf", "dae"};
}

std::optional<std::uint64_t> MeshFiles::count_triangles(const std::filesystem::path& file) const {
  const std::string e = ending(file);
  if (e == "obj") return count_obj_triangles(file);
  if (e == "stl") return count_stl_triangles(file);
  if (e == "ply") return count_ply_triangles(file);
  return std::nullopt;
}

std::vector<RawPart> MeshFiles::read(const std::filesystem::path& file, const RunContext& context) {
  const std::string e = ending(file);
  try {
    if (e == "obj") return read_obj(file, context);
    if (e == "stl") return read_stl(file, context);
    if (e == "off") return read_off(file, context);
    if (e == "ply") return read_ply(file, context);
    return read_with_assimp(file, context);
  } catch (const std::bad_alloc&) {
    throw InputError(file.string(), "too large for the memory of this machine");
  }
}

}  // namespace dismantle::mesh_files
