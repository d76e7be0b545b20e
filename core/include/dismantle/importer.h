/// Importers: files to raw parts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/geometry/mesh.h"

namespace dismantle {

/// A part as it stands in a file: not welded, not checked, transforms applied, input units.
struct RawPart {
  std::string name;
  std::string file;
  Mesh mesh;
};

class DISMANTLE_API Importer {
 public:
  virtual ~Importer();
  /// Lower-case file endings without dot that this importer reads.
  virtual std::vector<std::string> extensions() const = 0;
  /// All parts of one file, in file order. @throws InputError naming the file and what is wrong with it.
  virtual std::vector<RawPart> read(const std::filesystem::path& file) = 0;
};

}  // namespace dismantle
