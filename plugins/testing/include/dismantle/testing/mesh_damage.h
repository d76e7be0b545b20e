/// Random closed meshes and ways to damage them, for tests of repair and preparation.
#pragma once

#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/importer.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::shapes {

/// A random bumpy ball or tube, stretched and moved: closed, outward, without coincident vertices.
inline Mesh random_solid(Rng& rng) {
  Mesh m = rng.below(2) ? sphere(Vec3::Zero(), 1, 2) : refine(tube(0.4, 1, -1, 1, 9), 1);
  const Vec3 stretch = random_vector(rng, 0.3, 2);
  const double bump = rng.uniform(0, 0.03);
  for (auto& v : m.vertices) v = stretch.cwiseProduct(v * (1 + bump * rng.uniform(-1, 1)));
  return moved(m, random_pose(rng, 5));
}

/// Gives every triangle its own vertices, as in an STL file.
inline Mesh split_vertices(const Mesh& m) {
  Mesh out;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    const auto n = static_cast<std::uint32_t>(out.vertices.size());
    for (int c = 0; c < 3; ++c) out.vertices.push_back(m.vertex(t, c));
    out.triangles.push_back({n, n + 1, n + 2});
  }
  return out;
}

/// Reverses one triangle.
inline void flip(Mesh& m, std::size_t t) { std::swap(m.triangles[t][1], m.triangles[t][2]); }

/// A part as an importer returns it.
inline RawPart raw(const std::string& name, Mesh mesh) { return {name, name + ".obj", std::move(mesh)}; }

/// A temporary folder, removed with the object.
class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "dismantle-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TempFolder() {
    std::error_code ec;
    std::filesystem::remove_all(path_, ec);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// The text of the InputError that `f` throws, or "".
inline std::string input_error(const std::function<void()>& f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

/// True when one of the lines contains the text.
inline bool any_contains(const std::vector<std::string>& lines, const std::string& text) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

}  // namespace dismantle::shapes
