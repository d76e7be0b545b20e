/// Colours and units in files, and the material libraries of OBJ.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "dismantle/rgba.h"

namespace dismantle::mesh_files {

/// The single colour of a part; none when two of its faces differ.
class OneColour {
 public:
  void add(const std::optional<Rgba>& colour);
  std::optional<Rgba> get() const { return colour_; }

 private:
  bool any_ = false;
  std::optional<Rgba> colour_;
};

/// Converts channels in [0, 1]; values outside are clamped, non-finite values give no colour. `linear`: linear light,
/// else sRGB.
std::optional<Rgba> rgba(double r, double g, double b, double a, bool linear);

/// Kd and d (or Tr) of the materials in an .mtl file, by name. Empty if the file cannot be read.
std::map<std::string, Rgba> read_material_library(const std::filesystem::path& file);

}  // namespace dismantle::mesh_files
