/// Colours and units as files give them, and the material libraries of OBJ.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "dismantle/rgba.h"

namespace dismantle::mesh_files {

/// The one colour of a part, or none once two of its faces differ.
class OneColour {
 public:
  void add(const std::optional<Rgba>& colour);
  std::optional<Rgba> get() const { return colour_; }

 private:
  bool any_ = false;
  std::optional<Rgba> colour_;
};

/// From [0, 1] per channel; values outside are cut off, what is not finite is no colour. `linear`: linear light, else
/// sRGB.
std::optional<Rgba> rgba(double r, double g, double b, double a, bool linear);

/// Kd and d (or Tr) of the materials in an .mtl file, by name. A file that cannot be read has none.
std::map<std::string, Rgba> read_material_library(const std::filesystem::path& file);

/// "mm", "cm", "m", "inch", "foot", "micron" of a length in metres; empty when it is none of them.
std::string unit_of_length(double metres);

}  // namespace dismantle::mesh_files
