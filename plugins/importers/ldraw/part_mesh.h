/// The surface of a part: its file and all files that it refers to.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "dismantle/mesh.h"
#include "library.h"

namespace dismantle::ldraw {

/// A surface in LDraw units, or why there is none.
struct PartMesh {
  Mesh mesh;
  std::string problem{};
};

/// Files in files, and uses of files by one part or model, which nesting can multiply: far above those of real models.
inline constexpr std::size_t kDeepest = 200, kMostUses = 1'000'000;

/// Collects surfaces, each part file once.
class PartMeshes {
 public:
  explicit PartMeshes(Library& library) : library_(library) {}
  const PartMesh& of(const std::string& key);
  /// Triangles of a file with all that it refers to, without building them; stops counting at `limit`.
  std::uint64_t count(const std::string& key, std::uint64_t limit);

 private:
  void collect(const std::string& key, const Placement& placement, bool inverted, PartMesh& out);

  Library& library_;
  std::map<std::string, PartMesh> built_;
  std::map<std::string, std::uint64_t> counted_;
  std::size_t uses_ = 0;        // of files, by the part that is built
  std::set<std::string> open_;  // files that are being read: a file that refers to itself is refused
};

/// The polygons of one file, placed. `inverted`: the inside is out.
void add_polygons(const LdrawFile& file, const Placement& placement, bool inverted, Mesh& mesh);

}  // namespace dismantle::ldraw
