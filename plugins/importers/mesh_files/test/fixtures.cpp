#include "test/fixtures.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <array>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "dismantle/errors.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/mesh_repair.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::mesh_files::testing {
namespace {

void put(std::string& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
}

std::uint32_t crc32(std::string_view data) {
  std::uint32_t crc = 0xffffffffu;
  for (const char c : data) {
    crc ^= static_cast<unsigned char>(c);
    for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0u);
  }
  return ~crc;
}

}  // namespace

Mesh box(const Eigen::Vector3d& lo, const Eigen::Vector3d& hi) { return shapes::box(lo, hi); }

void expect_box(const RawPart& part, const Eigen::Vector3d& lo, const Eigen::Vector3d& hi) {
  EXPECT_EQ(part.problem, "");
  Mesh m = part.mesh;
  weld(m, 1e-6);
  EXPECT_EQ(m.triangles.size(), 12u) << part.name;
  EXPECT_TRUE(edge_use(m).closed()) << part.name;
  EXPECT_NEAR(signed_volume(m), (hi - lo).prod(), 1e-4) << part.name;
  EXPECT_LT((m.box().lo - lo).norm(), 1e-5) << part.name << " " << m.box().lo.transpose();
  EXPECT_LT((m.box().hi - hi).norm(), 1e-5) << part.name << " " << m.box().hi.transpose();
}

TempFolder::TempFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "dismantle-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TempFolder::~TempFolder() {
  std::error_code ec;
  std::filesystem::remove_all(path_, ec);
}

std::filesystem::path TempFolder::write(const std::string& name, std::string_view bytes) const {
  std::ofstream(path_ / name, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path_ / name;
}

std::string obj_text(const Mesh& mesh) {
  std::string s;
  for (const auto& v : mesh.vertices) s += fmt::format("v {:.17g} {:.17g} {:.17g}\n", v.x(), v.y(), v.z());
  for (const auto& t : mesh.triangles) s += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return s;
}

std::string binary_stl(const Mesh& mesh) {
  std::string s(80, ' ');
  put(s, static_cast<std::uint32_t>(mesh.triangles.size()), 4);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    s.append(12, '\0');
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) {
        const auto value = static_cast<float>(mesh.vertex(t, c)[k]);
        std::uint32_t bits;
        std::memcpy(&bits, &value, 4);
        put(s, bits, 4);
      }
    s.append(2, '\0');
  }
  return s;
}

std::string text_stl(const Mesh& mesh, const std::string& name) {
  std::string s = "solid " + name + "\n";
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    s += "facet normal 0 0 0\n outer loop\n";
    for (int c = 0; c < 3; ++c) {
      const auto& v = mesh.vertex(t, c);
      s += fmt::format("  vertex {:.17g} {:.17g} {:.17g}\n", v.x(), v.y(), v.z());
    }
    s += " endloop\nendfacet\n";
  }
  return s + "endsolid " + name + "\n";
}

std::string zip(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string out, directory;
  for (const auto& [name, data] : files) {
    const auto offset = static_cast<std::uint32_t>(out.size());
    const auto size = static_cast<std::uint32_t>(data.size());
    std::string common;
    put(common, 20, 2);
    put(common, 0, 2);
    put(common, 0, 2);  // stored
    put(common, 0, 4);
    put(common, crc32(data), 4);
    put(common, size, 4);
    put(common, size, 4);
    put(common, static_cast<std::uint32_t>(name.size()), 2);
    put(common, 0, 2);
    put(out, 0x04034b50, 4);
    out += common + name + data;
    put(directory, 0x02014b50, 4);
    put(directory, 20, 2);
    directory += common;
    put(directory, 0, 2);
    put(directory, 0, 2);
    put(directory, 0, 2);
    put(directory, 0, 4);
    put(directory, offset, 4);
    directory += name;
  }
  const auto start = static_cast<std::uint32_t>(out.size());
  const auto count = static_cast<std::uint32_t>(files.size());
  out += directory;
  put(out, 0x06054b50, 4);
  put(out, 0, 4);
  put(out, count, 2);
  put(out, count, 2);
  put(out, static_cast<std::uint32_t>(directory.size()), 4);
  put(out, start, 4);
  put(out, 0, 2);
  return out;
}

std::string input_error(const std::function<void()>& f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace dismantle::mesh_files::testing
