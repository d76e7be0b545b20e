// Untrusted files: the files that they name, the memory that they request, and the time that they take.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/errors.h"
#include "dismantle/run_context.h"
#include "mesh_files.h"
#include "readers.h"
#include "test/fixtures.h"

namespace dismantle::mesh_files {
namespace {

using testing::input_error;
using testing::TempFolder;

TEST(UntrustedFiles, ALineWithoutEndIsRefusedBeforeItIsAllInMemory) {
  const TempFolder folder;
  const std::string endless(std::size_t{17} << 20, '1');
  for (const char* name : {"a.obj", "a.off"}) {
    const auto file = folder.write(name, endless);
    EXPECT_NE(input_error([&] { MeshFiles().read(file, {}); }).find("too long"), std::string::npos) << name;
    EXPECT_FALSE(MeshFiles().count_triangles(file)) << name;
  }
}

TEST(UntrustedFiles, LinesAreTheSameHoweverTheyLieInBlocks) {
  const TempFolder folder;
  for (const std::size_t comment : {65534U, 65535U, 65536U, 65537U, 200000U}) {
    const std::string text =
        "#" + std::string(comment, 'x') + "\nv 0 0 0\nv 1 0 0\r\nv 0 1 0\n\nf 1 2 3";  // the last line has no end
    const auto parts = read_obj(folder.write("a.obj", text));
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].mesh.vertices.size(), 3U);
    EXPECT_EQ(parts[0].mesh.triangles.size(), 1U);
  }
}

TEST(UntrustedFiles, AMaterialLibraryThatIsAPipeIsNotWaitedFor) {
  const TempFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe.mtl").c_str(), 0600), 0);
  const auto parts = read_obj(folder.write("a.obj", "mtllib pipe.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_FALSE(parts[0].colour);
}

TEST(UntrustedFiles, AMaterialLibraryLiesBesideItsMesh) {
  const TempFolder folder;
  std::filesystem::create_directories(folder / "model/paint");
  for (const char* name : {"outside.mtl", "model/inside.mtl", "model/paint/below.mtl"})
    folder.write(name, "newmtl m\nKd 1 0 0\n");
  std::filesystem::create_symlink("../outside.mtl", folder / "model/link.mtl");
  const std::string absolute = (folder / "outside.mtl").string();
  for (const auto& [library, is_read] : std::vector<std::pair<std::string, bool>>{{"inside.mtl", true},
                                                                                  {"paint/below.mtl", true},
                                                                                  {"paint/../inside.mtl", true},
                                                                                  {"../outside.mtl", false},
                                                                                  {"link.mtl", false},
                                                                                  {absolute, false}}) {
    const auto parts =
        read_obj(folder.write("model/a.obj", "mtllib " + library + "\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].colour.has_value(), is_read) << library;
  }
}

/// The same triangle in a buffer within the folder of the model and outside of it.
TEST(UntrustedFiles, AGltfReadsNothingOutsideOfItsFolder) {
  const TempFolder folder;
  std::filesystem::create_directories(folder / "model/sub");
  const std::array<float, 9> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::string bytes(reinterpret_cast<const char*>(corners.data()), sizeof corners);
  for (const char* name : {"outside.bin", "model/inside.bin", "model/sub/below.bin"}) folder.write(name, bytes);
  std::filesystem::create_symlink("../outside.bin", folder / "model/link.bin");
  const auto model = [&](const std::string& uri) {
    return folder.write(
        "model/a.gltf",
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"n","mesh":0}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
        R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],)"
        R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":")" +
            uri + "\"}]}");
  };
  for (const char* uri : {"inside.bin", "sub/below.bin", "sub/../inside.bin"}) {
    const auto parts = MeshFiles().read(model(uri), {});
    ASSERT_EQ(parts.size(), 1U) << uri;
    EXPECT_EQ(parts[0].mesh.triangles.size(), 1U) << uri;
    EXPECT_EQ(MeshFiles().referenced_files(folder / "model/a.gltf").size(), 1U) << "the hash covers it";
  }
  for (const std::string& uri :
       {std::string("../outside.bin"), std::string("sub/../../outside.bin"), std::string("link.bin"),
        (folder / "outside.bin").string(), std::string("/dev/zero"), std::string("missing.bin")})
    EXPECT_NE(input_error([&] { MeshFiles().read(model(uri), {}); }).find("no file in its folder"), std::string::npos)
        << uri;
}

TEST(UntrustedFiles, ReadingEndsWhenItIsToldTo) {
  const TempFolder folder;
  const Mesh box = testing::box({0, 0, 0}, {1, 1, 1});
  RunContext stopped;
  stopped.cancel.cancel();
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const auto& file :
       {folder.write("a.obj", testing::obj_text(box)), folder.write("a.stl", testing::text_stl(box, "x")),
        folder.write("b.stl", testing::binary_stl(box)), folder.write("a.ply", ply), folder.write("a.off", off)}) {
    EXPECT_FALSE(MeshFiles().read(file, {}).empty()) << file;
    try {
      MeshFiles().read(file, stopped);
      ADD_FAILURE() << file;
    } catch (const InputError& e) {
      ADD_FAILURE() << e.what();  // the file is valid
    } catch (const Error&) {
    }
  }
}

/// An executable script that replaces assimp_reader.
std::filesystem::path reader_that(const TempFolder& folder, const std::string& lines) {
  const auto program = folder.write("reader", "#!/bin/sh\n" + lines);
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  return program;
}

TEST(ReaderOfScenes, EveryEndBecomesAnErrorThatNamesTheFile) {
  const TempFolder folder;
  const auto file = folder.write("gear box.gltf", "{}");
  for (const auto& [script, said] : std::vector<std::pair<const char*, const char*>>{
           {"exit 0\n", "ended early"},
           {"exit 3\n", "status 3"},
           {"kill -SEGV $$\n", "assimp crashed on it (signal 11"},
           {"echo garbage\n", "cannot be used"},
           {"head -c 3000000 /dev/zero\n", "cannot be used"},
           {"echo 'std::bad_alloc' >&2; kill -ABRT $$\n", "importers.mesh_files.memory_limit"},
           {"sleep 20\n", "importers.mesh_files.time_limit"}}) {
    MeshFiles importer({.time_limit = 1}, reader_that(folder, script));
    const std::string error = input_error([&] { importer.read(file, {}); });
    EXPECT_NE(error.find("gear box.gltf: "), std::string::npos) << script << error;
    EXPECT_NE(error.find(said), std::string::npos) << script << error;
    EXPECT_NE(error.find("export"), std::string::npos) << script << error;
  }
  MeshFiles without({}, folder / "nowhere");
  EXPECT_NE(input_error([&] { without.read(file, {}); }).find("nowhere is missing"), std::string::npos);
}

TEST(ReaderOfScenes, EndsWhenItIsToldToStop) {
  const TempFolder folder;
  const auto file = folder.write("a.gltf", "{}");
  MeshFiles importer({}, reader_that(folder, "sleep 60\n"));
  RunContext context;
  context.cancel.cancel();
  EXPECT_THROW(importer.read(file, context), Error);
}

/// Debian's assimp ends the process on some of these: RapidJSON asserts, in release builds too.
TEST(ReaderOfScenes, DamagedFilesAreRefusedByName) {
  const TempFolder folder;
  const std::string whole =
      R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "accessors": [{"bufferView": 0, "componentType": 5126,
    "count": 3, "type": "VEC3"}], "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36}]})";
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"\"nodes\": [0]", "\"nodes\": 5"},
                                                        {"\"scene\": 0", "\"scene\": []"},
                                                        {"{\"mesh\": 0}", "7"},
                                                        {"\"POSITION\": 0", "\"POSITION\": {}"},
                                                        {"\"count\": 3", "\"count\": -3"},
                                                        {"\"count\": 3", "\"count\": 4e18"},
                                                        {"{\"buffer\": 0", "{\"buffer\": 9"},
                                                        {"\"2.0\"", "2"}}) {
    std::string damaged = whole;
    damaged.replace(damaged.find(from), from.size(), to);
    const auto file = folder.write("damaged.gltf", damaged);
    const std::string error = input_error([&] { MeshFiles().read(file, {}); });
    EXPECT_NE(error.find("damaged.gltf: "), std::string::npos) << to << ": " << error;
  }
}

}  // namespace
}  // namespace dismantle::mesh_files
