/// LDraw files as text: references, surfaces and the statements that matter (LDraw file format specification 1.0.2).
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dismantle::ldraw {

/// x -> linear * x + shift, LDraw units.
struct Placement {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Placement operator*(const Placement& inner) const { return {linear * inner.linear, linear * inner.shift + shift}; }
};

/// A line of type 1: another file, placed.
struct Reference {
  std::string name;    ///< as name_key()
  std::string colour;  ///< code; "16" is that of the referring file
  Placement placement;
  bool inverted = false;  ///< by BFC INVERTNEXT
};

/// A line of type 1 that the file itself takes out of the model.
struct Hidden {
  Reference reference;
  std::string why;
};

/// A line of type 3 or 4.
struct Polygon {
  std::vector<Eigen::Vector3d> corners;  ///< three or four
  std::string colour;
  bool clockwise = false;  ///< the winding that BFC states; counter-clockwise where it states none
};

/// `0 STEP`, `0 ROTSTEP x y z MODE`: the step that ends before reference `before`.
struct StepEnd {
  std::size_t before = 0;
  std::optional<Eigen::Vector3d> turn{};  ///< degrees about x, y, z
  std::string mode{};                     ///< "ABS", "REL", "ADD"; empty: `turn` ends ("END"), or a plain STEP
  bool ends_turn = false;
};

/// A part that bends, drawn by a program along its path as segments: `0 SYNTH SYNTHESIZED BEGIN` to `END` of LSynth,
/// all behind `0 !LDCAD GENERATED` of LDCad. Its references are [first, end).
struct Bent {
  std::string name;  ///< what LSynth calls it; empty: the file is the part
  std::size_t first = 0, end = 0;
};

/// A statement !COLOUR.
struct Colour {
  std::string code;
  std::string value;    ///< "#RRGGBB"
  bool rubber = false;  ///< its finish is RUBBER: parts in it bend
};

struct LdrawFile {
  std::string name;         ///< as it names itself
  std::string description;  ///< its first line, blanks reduced
  std::string category;     ///< of !CATEGORY; empty: the first word of the description
  std::string type;         ///< of !LDRAW_ORG: "Part", "Shortcut", "Primitive", "Model"; empty: not stated
  std::vector<Reference> references;
  std::vector<Hidden> hidden;
  std::vector<Bent> bent;  ///< in the order of the references, apart from one another
  std::vector<Polygon> polygons;
  std::vector<StepEnd> steps;
  std::vector<Colour> colours;
};

/// The name by which files are found: lower case, '/' between folders.
std::string name_key(std::string_view name);

/// The files in `text`: one, or the blocks of a multi-part document by their keys, the first one at `first`.
struct Document {
  std::string first;
  std::map<std::string, LdrawFile> files;
};

/// @throws InputError with the line of what cannot be read.
Document parse(const std::string& text, const std::filesystem::path& file);

/// @throws InputError when the file cannot be opened.
std::string text_of(const std::filesystem::path& file);

}  // namespace dismantle::ldraw
