// Readers of mesh files: one program for each format, FUZZ_ENDING says which. For `assimp` the first byte chooses among the
// formats that are read through assimp.
#include <string_view>

#include "dismantle/errors.h"
#include "input_file.h"
#include "mesh_files.h"
#include "raw_parts.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dismantle;
  fuzz::Bytes bytes(data, size);
  std::string ending = FUZZ_ENDING;
  if (ending == "assimp") {
    if (bytes.empty()) return 0;
    static constexpr const char* kEndings[] = {"glb", "gltf", "3mf", "dae"};
    ending = kEndings[bytes[0] % 4];
    bytes = bytes.subspan(1);
  }
  const auto file = fuzz::input_file("part." + ending, bytes);
  mesh_files::MeshFiles importer;
  importer.count_triangles(file);
  try {
    fuzz::expect_sound(importer.read(file, {}));
  } catch (const InputError&) {  // says what is wrong
  }
  return 0;
}
