/// Importers: files to raw parts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/mesh.h"
#include "dismantle/rgba.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// A part as it stands in a file: not welded, not checked, transforms applied, input units.
struct RawPart {
  std::string name{};
  std::string file{};
  Mesh mesh{};
  std::optional<Rgba> colour{};
  std::vector<std::string> parents{};  ///< assemblies in the file that it is in, outermost first
  std::string unit{};                  ///< of its coordinates ("mm", "inch", "m"), as far as the file says; else empty
  std::string problem{};               ///< not empty: it cannot be used, and why; `mesh` is ignored
};

/// Reads files of some formats into raw parts.
class DISMANTLE_API Importer {
 public:
  virtual ~Importer();
  /// Lower-case file endings without dot that this importer reads.
  virtual std::vector<std::string> extensions() const = 0;
  /// Number of triangles in the file as far as it can be told without building it in memory, else nothing: lets the
  /// caller refuse a file that is too large. Never throws for broken files; `read` says what is wrong with them.
  virtual std::optional<std::uint64_t> count_triangles(const std::filesystem::path& file) const;
  /// All parts of one file, in file order. What is worth a warning goes to the context's log.
  /// @throws InputError naming the file and what is wrong with it. @throws Error when `context` wants to stop.
  virtual std::vector<RawPart> read(const std::filesystem::path& file, const RunContext& context) = 0;
};

}  // namespace dismantle
