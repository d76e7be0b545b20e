/// The importer: selects the reader by the file's extension.
#pragma once

#include <filesystem>

#include "dismantle/importer.h"
#include "dismantle/parameters.h"

namespace dismantle::mesh_files {

/// `importers: {mesh_files: ...}` in a configuration. Limits for glTF, 3MF and DAE files, which another process reads.
struct MeshFilesParameters {
  double time_limit = 600;
  double memory_limit = 4096;
  static void describe(Schema<MeshFilesParameters>& s);
};

class MeshFiles : public Importer {
 public:
  explicit MeshFiles(const MeshFilesParameters& params = {});
  /// `reader`: the program to start for glTF, 3MF and DAE files, which may be missing.
  MeshFiles(const MeshFilesParameters& params, std::filesystem::path reader);
  std::vector<std::string> extensions() const override;
  std::optional<std::uint64_t> count_triangles(const std::filesystem::path& file) const override;
  std::vector<RawPart> read(const std::filesystem::path& file, const RunContext& context) override;
  std::vector<std::filesystem::path> referenced_files(const std::filesystem::path& file) const override;

 private:
  std::vector<RawPart> read_with_assimp(const std::filesystem::path& file, const RunContext& context) const;

  MeshFilesParameters params_;
  std::filesystem::path reader_;
};

}  // namespace dismantle::mesh_files
