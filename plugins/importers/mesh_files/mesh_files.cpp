#include "mesh_files.h"

#include <fmt/format.h>

#include <new>
#include <utility>

#include "dismantle/errors.h"
#include "gltf_container.h"
#include "input_limits.h"
#include "read_in_child.h"
#include "readers.h"
#include "text_scan.h"

namespace dismantle::mesh_files {
namespace {

std::string ending(const std::filesystem::path& file) {
  std::string e = file.extension().string();
  if (!e.empty()) e.erase(0, 1);
  return lower_case(e);
}

}  // namespace

void MeshFilesParameters::describe(Schema<MeshFilesParameters>& s) {
  s.add("time_limit", &MeshFilesParameters::time_limit,
        {.unit = "s", .min = 0, .max = 1e6, .doc = "Time limit for reading a glTF, 3MF or DAE file; 0 = no limit."});
  s.add("memory_limit", &MeshFilesParameters::memory_limit,
        {.unit = "MiB",
         .min = 0,
         .max = 1e7,
         .doc = "Address space limit of the process that reads a glTF, 3MF or DAE file; 0 = no limit."});
}

MeshFiles::MeshFiles(const MeshFilesParameters& params)
    : MeshFiles(params, reader_process::installed_reader("assimp_reader")) {}

MeshFiles::MeshFiles(const MeshFilesParameters& params, std::filesystem::path reader)
    : params_(params), reader_(std::move(reader)) {}

std::vector<RawPart> MeshFiles::read_with_assimp(const std::filesystem::path& file, const RunContext& context) const {
  const reader_process::ReaderProgram program{.path = reader_,
                                              .formats = "glTF, 3MF and DAE files",
                                              .library = "assimp",
                                              .instead = "export it again, or export the parts as OBJ or STL",
                                              .missing = "install Dismantle again, or export the parts as OBJ or STL",
                                              .parameters = "importers.mesh_files",
                                              .coarser = ""};
  const reader_process::ReaderLimits limits{params_.time_limit,
                                            static_cast<std::uint64_t>(params_.memory_limit * 1024 * 1024)};
  std::vector<RawPart> parts =
      read_in_child(file, program, {}, limits, reader_process::kInputLimits.triangles, context);
  for (RawPart& part : parts) part.file = file.filename().string();
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

std::vector<std::filesystem::path> MeshFiles::referenced_files(const std::filesystem::path& file) const {
  const std::string e = ending(file);
  return e == "gltf" || e == "glb" ? buffers_of_gltf(file) : std::vector<std::filesystem::path>();
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
