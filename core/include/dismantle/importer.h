/// Importers: files to raw parts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/mesh.h"
#include "dismantle/reference_step.h"
#include "dismantle/rgba.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// A part as read from a file: not welded, not checked, transforms applied, input units.
struct RawPart {
  std::string name{};
  std::string file{};
  Mesh mesh{};
  std::optional<Rgba> colour{};
  std::vector<std::string> parents{};  ///< assemblies in the file that contain it, outermost first
  std::string unit{};                  ///< of its coordinates ("mm", "inch", "m"); empty if the file does not say
  std::string problem{};               ///< not empty: why the part cannot be used; `mesh` is then ignored
  /// Of a part with a `problem`: the file itself says that it is no part of the assembly (hidden, support, annotation).
  /// That is a note. All other problems are parts that the plan lacks: a warning, exit status 1.
  bool by_meaning{};
  /// Ids, unique in the file, of the uses of products that contain it, outermost first; the last one is the product
  /// whose body it is. Empty: the format has no products.
  std::vector<std::string> instances{};
  std::string product{};            ///< name of that product
  std::optional<double> density{};  ///< g/cm3, if the file states it
  bool flexible{};                  ///< the file says that its material bends, such as rubber (docs/concepts.md)
};

/// Reads files of some formats into raw parts.
class DISMANTLE_API Importer {
 public:
  virtual ~Importer();
  /// Extensions of the files that this importer reads, lower-case, without dot.
  virtual std::vector<std::string> extensions() const = 0;
  /// Number of triangles in the file, if known without building the meshes in memory. Lets the caller refuse a file
  /// that is too large. Never throws for broken files; `read` reports their problems.
  virtual std::optional<std::uint64_t> count_triangles(const std::filesystem::path& file) const;
  /// All parts that the file declares, in file order, also those that cannot be read: these have a `problem`. Nothing
  /// is left away in silence. Warnings go to the context's log; the caller counts them as findings about the input.
  /// @throws InputError naming the file and what is wrong with it. @throws Error when `context` wants to stop.
  virtual std::vector<RawPart> read(const std::filesystem::path& file, const RunContext& context) = 0;
  /// The order in which the file's author builds the assembly: indices into the list that `read` returns. Empty: the
  /// file states none. Called after `read` of the same file. @throws as read().
  virtual std::vector<ReferenceStep> reference_order(const std::filesystem::path& file, const RunContext& context);
  /// Other files that `read` opens for their geometry, because `file` refers to them: buffers, external references.
  /// Only files that may_read_referenced() allows. Never throws for broken files.
  virtual std::vector<std::filesystem::path> referenced_files(const std::filesystem::path& file) const;
};

}  // namespace dismantle
