/// A glTF 2.0 file: its JSON, its buffers and the numbers in them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace dismantle::mesh_files {

/// Numbers of an accessor, `components` for each of `count` items.
struct GltfNumbers {
  std::size_t components = 1, count = 0;
  std::vector<double> values;
  double at(std::size_t item, std::size_t component) const { return values[item * components + component]; }
};

class GltfDocument {
 public:
  using Json = nlohmann::json;

  /// @throws InputError when it is no glTF file, or a file of another version.
  explicit GltfDocument(const std::filesystem::path& file);

  const Json& root() const { return root_; }
  /// Item `index` of a list of the root. @throws InputError when there is none.
  const Json& item(const char* list, const Json& index) const;
  /// Integers are as stored; normalised ones are in [-1, 1]. Sparse accessors are filled in.
  /// @throws InputError for numbers outside of their buffer, and for compression that is not read.
  GltfNumbers numbers(const Json& accessor);
  /// Bytes of a buffer view. @throws InputError as numbers().
  std::string_view bytes_of_view(const Json& view);

  [[noreturn]] void fail(const std::string& problem) const;

 private:
  std::string_view buffer(std::size_t index);
  void read_items(const Json& view, std::size_t offset, std::size_t component_type, bool normalized, GltfNumbers& out);

  std::filesystem::path file_;
  Json root_;
  std::string binary_;  // chunk of a GLB file
  bool has_binary_ = false;
  std::map<std::size_t, std::string> buffers_;
};

/// Major version of a glTF file, 0 when it cannot be told.
int version_of_gltf(const std::filesystem::path& file);

}  // namespace dismantle::mesh_files
