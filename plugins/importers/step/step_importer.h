/// Reads STEP files with a separate program, step_reader.
#pragma once

#include <cstdint>
#include <filesystem>

#include "dismantle/importer.h"
#include "dismantle/parameters.h"

namespace dismantle::step_import {

/// `importers: {step: ...}` in a configuration.
struct StepParameters {
  double linear_deflection = 0.01;
  double assembly_deflection = 0.001;
  double angular_deflection = 0.35;
  std::int64_t triangle_limit = 5'000'000;
  double time_limit = 600;
  double memory_limit = 8192;
  static void describe(Schema<StepParameters>& s);
};

class StepImporter : public Importer {
 public:
  /// Uses the reader program that was installed with this plugin.
  explicit StepImporter(const StepParameters& params);
  /// `reader`: the program to start, which may be missing.
  StepImporter(const StepParameters& params, std::filesystem::path reader);

  std::vector<std::string> extensions() const override;
  std::vector<RawPart> read(const std::filesystem::path& file, const RunContext& context) override;
  std::vector<std::filesystem::path> referenced_files(const std::filesystem::path& file) const override;

 private:
  StepParameters params_;
  std::filesystem::path reader_;
};

}  // namespace dismantle::step_import
