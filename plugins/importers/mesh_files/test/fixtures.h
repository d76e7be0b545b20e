/// Synthetic meshes and files for the importer's tests.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dismantle/importer.h"
#include "dismantle/mesh.h"

namespace dismantle::mesh_files::testing {

/// Box from `lo` to `hi`, outward.
Mesh box(const Eigen::Vector3d& lo, const Eigen::Vector3d& hi);

/// The part must be a closed outward box from `lo` to `hi`, without a problem.
void expect_box(const RawPart& part, const Eigen::Vector3d& lo, const Eigen::Vector3d& hi);

/// A temporary folder for one test, removed at its end.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// Writes `bytes` to a file in the folder.
  std::filesystem::path write(const std::string& name, std::string_view bytes) const;

 private:
  std::filesystem::path path_;
};

std::string obj_text(const Mesh& mesh);
std::string binary_stl(const Mesh& mesh);
std::string text_stl(const Mesh& mesh, const std::string& name);
/// A zip archive without compression.
std::string zip(const std::vector<std::pair<std::string, std::string>>& files);

/// The text of the InputError that `f` throws, or "".
std::string input_error(const std::function<void()>& f);

}  // namespace dismantle::mesh_files::testing
