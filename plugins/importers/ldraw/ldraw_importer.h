/// Reads LDraw models with the parts library.
#pragma once

#include <filesystem>
#include <string>

#include "dismantle/importer.h"
#include "dismantle/parameters.h"

namespace dismantle::ldraw {

/// `importers: {ldraw: ...}` in a configuration.
struct LdrawParameters {
  std::string library;
  static void describe(Schema<LdrawParameters>& s);
};

class LdrawImporter : public Importer {
 public:
  explicit LdrawImporter(const LdrawParameters& params = {}) : params_(params) {}
  std::vector<std::string> extensions() const override { return {"ldr", "mpd"}; }
  std::optional<std::uint64_t> count_triangles(const std::filesystem::path& file) const override;
  std::vector<RawPart> read(const std::filesystem::path& file, const RunContext& context) override;
  std::vector<ReferenceStep> reference_order(const std::filesystem::path& file, const RunContext& context) override;
  std::vector<std::filesystem::path> referenced_files(const std::filesystem::path& file) const override;

 private:
  LdrawParameters params_;
};

}  // namespace dismantle::ldraw
