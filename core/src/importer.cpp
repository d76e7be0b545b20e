#include "dismantle/importer.h"

namespace dismantle {

std::optional<std::uint64_t> Importer::count_triangles(const std::filesystem::path&) const { return std::nullopt; }

std::vector<ReferenceStep> Importer::reference_order(const std::filesystem::path&, const RunContext&) { return {}; }

std::vector<std::filesystem::path> Importer::referenced_files(const std::filesystem::path&) const { return {}; }

}  // namespace dismantle
