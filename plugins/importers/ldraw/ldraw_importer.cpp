#include "ldraw_importer.h"

#include <fmt/format.h>

#include <limits>

#include "dismantle/errors.h"
#include "model.h"
#include "part_mesh.h"

namespace dismantle::ldraw {
namespace {

constexpr std::uint64_t kMostTriangles = 50'000'000;  // of one model; the limit of the configuration is lower

}  // namespace

void LdrawParameters::describe(Schema<LdrawParameters>& s) {
  s.add("library", &LdrawParameters::library,
        {.doc =
             "Folder of the LDraw parts library (it holds 'parts' and 'p'). Empty: $LDRAWDIR, or a folder 'library' or "
             "'ldraw' beside the model or beside its folder."});
}

std::optional<std::uint64_t> LdrawImporter::count_triangles(const std::filesystem::path& file) const {
  try {
    Library library(file, params_.library);
    return PartMeshes(library).count(library.first(), std::numeric_limits<std::uint64_t>::max() / 2);
  } catch (const std::exception&) {
    return std::nullopt;  // read() says what is wrong with the file
  }
}

std::vector<RawPart> LdrawImporter::read(const std::filesystem::path& file, const RunContext& context) {
  Library library(file, params_.library);
  if (PartMeshes(library).count(library.first(), kMostTriangles) >= kMostTriangles)
    throw InputError(file.string(), fmt::format("it has more than {} triangles", kMostTriangles - 1));
  return model_of(library, context).parts;
}

std::vector<ReferenceStep> LdrawImporter::reference_order(const std::filesystem::path& file,
                                                          const RunContext& context) {
  Library library(file, params_.library);
  return model_of(library, context).order;
}

std::vector<std::filesystem::path> LdrawImporter::referenced_files(const std::filesystem::path& file) const {
  try {
    Library library(file, params_.library);
    PartMeshes(library).count(library.first(), kMostTriangles);  // opens all files
    return library.own_files();
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace dismantle::ldraw
