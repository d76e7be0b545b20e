/// The importer: chooses the reader by the file's ending.
#pragma once

#include "dismantle/importer.h"

namespace dismantle::mesh_files {

class MeshFiles : public Importer {
 public:
  std::vector<std::string> extensions() const override;
  std::optional<std::uint64_t> count_triangles(const std::filesystem::path& file) const override;
  std::vector<RawPart> read(const std::filesystem::path& file, const RunContext& context) override;
};

}  // namespace dismantle::mesh_files
