// Stanford PLY, text and binary in both byte orders, in double precision. (assimp's reader does not terminate on some
// damaged files.)
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/geometry/mesh_measure.h"
#include "readers.h"
#include "text_scan.h"

namespace dismantle::mesh_files {
namespace {

enum class Scalar { i8, u8, i16, u16, i32, u32, f32, f64 };

std::optional<Scalar> scalar_named(std::string_view name) {
  if (name == "char" || name == "int8") return Scalar::i8;
  if (name == "uchar" || name == "uint8") return Scalar::u8;
  if (name == "short" || name == "int16") return Scalar::i16;
  if (name == "ushort" || name == "uint16") return Scalar::u16;
  if (name == "int" || name == "int32") return Scalar::i32;
  if (name == "uint" || name == "uint32") return Scalar::u32;
  if (name == "float" || name == "float32") return Scalar::f32;
  if (name == "double" || name == "float64") return Scalar::f64;
  return std::nullopt;
}

std::size_t size_of(Scalar s) {
  switch (s) {
    case Scalar::i8:
    case Scalar::u8:
      return 1;
    case Scalar::i16:
    case Scalar::u16:
      return 2;
    case Scalar::f64:
      return 8;
    default:
      return 4;
  }
}

struct Property {
  std::string name;
  Scalar type = Scalar::f32;
  std::optional<Scalar> count;  ///< set: a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Format { text, little, big };

class PlyReader {
 public:
  explicit PlyReader(const std::filesystem::path& file, const RunContext& context = {})
      : file_(file), context_(context), in_(file, std::ios::binary) {
    if (!in_) throw InputError(file.string(), "cannot be opened");
  }

  std::optional<std::uint64_t> faces_stated() {
    header();
    for (const auto& e : elements_)
      if (e.name == "face") return e.count;
    return std::nullopt;
  }

  std::vector<RawPart> read() {
    header();
    RawPart part;
    part.file = file_.filename().string();
    for (const auto& element : elements_) {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        if (i % 1024 == 0) stop_if_told(context_, file_);
        where_ = fmt::format("{} {} of {}", element.name, i + 1, element.count);
        row(element, part.mesh);
      }
    }
    where_.clear();
    for (char c; in_.get(c);)
      if (c != '\0' && std::isspace(static_cast<unsigned char>(c)) == 0)
        fail("it goes on behind the elements that its header states: their numbers are wrong");
    if (part.mesh.vertices.empty()) fail("no vertices");
    for (std::vector<std::uint32_t>& corners : std::exchange(before_vertices_, {})) {
      corners_ = std::move(corners);
      add_face(part.mesh);
    }
    for (const auto& t : part.mesh.triangles)
      for (const auto v : t)
        if (v >= part.mesh.vertices.size())
          fail(fmt::format("a face names vertex {}, there are {}, counted from 0", v, part.mesh.vertices.size()));
    where_.clear();
    if (part.mesh.triangles.empty())
      fail(std::ranges::any_of(
               elements_, [](const Element& e) { return e.count > 0 && (e.name == "face" || e.name == "tristrips"); })
               ? "its faces have no list 'vertex_indices' with three corners"
               : "only points, no faces");
    std::vector<RawPart> parts;
    parts.push_back(std::move(part));
    return parts;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(file_.string(), where_.empty() ? problem : where_ + ": " + problem);
  }

  std::string header_line() {
    std::string line;
    char c;
    while (in_.get(c) && c != '\n' && (c != '\r' || line_end_ == '\n')) {
      line += c;
      if (line.size() > 4096) fail("this is no PLY header");
    }
    if (!in_) fail("the header is cut off");
    // The first line shows how lines end. In a binary file, LF after a CR may be the first byte of the data.
    if (++header_lines_ == 1) {
      line_end_ = c == '\r' && in_.peek() != '\n' ? '\r' : '\n';
      if (c != line_end_) in_.get(c);
    }
    where_ = fmt::format("line {}", header_lines_);
    return std::string(trimmed(line));
  }

  void header() {
    if (header_line() != "ply") fail("a PLY file starts with 'ply'");
    bool formatted = false;
    for (;;) {
      const std::string line = header_line();
      std::string_view rest = line;
      const std::string_view keyword = take_word(rest);
      if (keyword == "end_header") break;
      if (keyword == "format") {
        const std::string_view f = take_word(rest);
        if (f == "ascii")
          format_ = Format::text;
        else if (f == "binary_little_endian")
          format_ = Format::little;
        else if (f == "binary_big_endian")
          format_ = Format::big;
        else
          fail("unknown format");
        formatted = true;
      } else if (keyword == "element") {
        Element element;
        element.name = std::string(take_word(rest));
        const auto n = to_integer(take_word(rest));
        if (!n || *n < 0 || *n > 0xfffffffell) fail("an element needs its number");
        element.count = static_cast<std::uint64_t>(*n);
        elements_.push_back(std::move(element));
      } else if (keyword == "property") {
        if (elements_.empty()) fail("a property before any element");
        elements_.back().properties.push_back(property(rest));
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        fail("this line does not belong into a PLY header");
      }
    }
    if (!formatted) fail("the header states no format");
    for (const auto& e : elements_)
      if (e.properties.empty() && e.count > 0) fail(fmt::format("element '{}' has no properties", e.name));
  }

  Property property(std::string_view rest) const {
    Property p;
    std::string_view word = take_word(rest);
    if (word == "list") {
      p.count = scalar_named(take_word(rest));
      if (!p.count) fail("unknown type");
      word = take_word(rest);
    }
    const auto type = scalar_named(word);
    if (!type) fail("unknown type");
    p.type = *type;
    p.name = std::string(take_word(rest));
    return p;
  }

  double value(Scalar type) {
    if (format_ == Format::text) {
      if (!(in_ >> word_)) fail("the file is cut off here");
      if (word_.size() > 400) fail("this is no number");
      const auto v = to_double(word_);
      if (!v) fail("this is no number");
      return *v;
    }
    unsigned char bytes[8] = {};
    const std::size_t n = size_of(type);
    if (!in_.read(reinterpret_cast<char*>(bytes), static_cast<std::streamsize>(n))) fail("the file is cut off here");
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < n; ++k)
      bits |= std::uint64_t{bytes[format_ == Format::little ? k : n - 1 - k]} << (8 * k);
    switch (type) {
      case Scalar::i8:
        return static_cast<std::int8_t>(bits);
      case Scalar::i16:
        return static_cast<std::int16_t>(bits);
      case Scalar::i32:
        return static_cast<std::int32_t>(bits);
      case Scalar::f32:
        return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
      case Scalar::f64:
        return std::bit_cast<double>(bits);
      default:
        return static_cast<double>(bits);
    }
  }

  void row(const Element& element, Mesh& mesh) {
    const bool vertex = element.name == "vertex", strips = element.name == "tristrips";
    const bool face = element.name == "face" || strips;
    Eigen::Vector3d p = Eigen::Vector3d::Constant(std::nan(""));
    for (const auto& property : element.properties) {
      if (!property.count) {
        const double v = value(property.type);
        if (vertex && property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
          p[property.name[0] - 'x'] = v;
        continue;
      }
      const double n = value(*property.count);
      const double most = strips ? 4294967295.0 : 1e6;  // one strip may be the whole surface
      if (!(n >= 0 && n <= most)) fail("a list of impossible length");
      corners_.clear();
      for (double k = 0; k < n; ++k) {
        const double v = value(property.type);
        if (!face) continue;
        if (strips && (v == -1 || v == 4294967295.0)) {  // a new strip begins
          corners_.push_back(kNewStrip);
          continue;
        }
        if (!(v >= 0 && v < 4294967295.0 && v == std::floor(v))) fail("no vertex has this number");
        corners_.push_back(static_cast<std::uint32_t>(v));
      }
      const bool corners = property.name == "vertex_indices" || property.name == "vertex_index";
      if (corners && strips) add_strips(mesh);
      if (corners && face && !strips) add_face(mesh);
    }
    if (!vertex) return;
    if (!p.allFinite()) fail("its coordinates are missing or not finite");
    mesh.vertices.push_back(p);
  }

  /// Every second triangle of a strip is turned around; triangles without area only lead on.
  void add_strips(Mesh& mesh) const {
    for (std::size_t i = 0, begin = 0; i < corners_.size(); ++i) {
      if (corners_[i] == kNewStrip) begin = i + 1;
      if (i < begin + 2) continue;
      Triangle t{corners_[i - 2], corners_[i - 1], corners_[i]};
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      if ((i - begin) % 2 == 1) std::swap(t[0], t[1]);
      mesh.triangles.push_back(t);
    }
  }

  void add_face(Mesh& mesh) {
    if (corners_.size() < 3) return;
    if (mesh.vertices.empty()) {  // the vertices come after the faces
      before_vertices_.push_back(corners_);
      return;
    }
    points_.clear();
    if (corners_.size() > 3)
      for (const auto v : corners_) {
        if (v >= mesh.vertices.size()) fail(fmt::format("vertex {} does not exist", v));
        points_.push_back(mesh.vertices[v]);
      }
    const auto cut = corners_.size() > 3 ? triangulate_polygon(points_) : std::vector<Triangle>{{0, 1, 2}};
    for (const auto& t : cut) mesh.triangles.push_back({corners_[t[0]], corners_[t[1]], corners_[t[2]]});
    if (cut.empty())  // self-intersecting or without area: a fan keeps the surface closed
      for (std::size_t k = 2; k < corners_.size(); ++k)
        mesh.triangles.push_back({corners_[0], corners_[k - 1], corners_[k]});
  }

  std::filesystem::path file_;
  RunContext context_;
  std::ifstream in_;
  static constexpr std::uint32_t kNewStrip = 0xffffffffu;
  Format format_ = Format::text;
  char line_end_ = '\0';  // of the header; not known before its first line
  std::vector<Element> elements_;
  std::vector<std::vector<std::uint32_t>> before_vertices_;  // faces that wait for their vertices
  std::size_t header_lines_ = 0;
  std::string where_, word_;
  std::vector<std::uint32_t> corners_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace

std::vector<RawPart> read_ply(const std::filesystem::path& file, const RunContext& context) {
  return PlyReader(file, context).read();
}

std::optional<std::uint64_t> count_ply_triangles(const std::filesystem::path& file) {
  try {
    return PlyReader(file).faces_stated();
  } catch (const InputError&) {
    return std::nullopt;  // read_ply() reports the error
  }
}

}  // namespace dismantle::mesh_files
