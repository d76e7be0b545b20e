// Wavefront OBJ in double precision.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

#include "appearance.h"
#include "dismantle/errors.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/referenced_file.h"
#include "readers.h"
#include "text_scan.h"

namespace dismantle::mesh_files {
namespace {

/// Triangles under one `o` or `g` name.
struct Section {
  std::string name;
  std::vector<Triangle> triangles;
  std::set<std::string> materials{};  ///< of its faces; "" where none was named
  std::string last_material{};        ///< of the last face
};

class ObjReader {
 public:
  ObjReader(const std::filesystem::path& file, const RunContext& context)
      : file_(file), context_(context), lines_(file, context) {}

  std::vector<RawPart> read() {
    std::string_view line;
    while (lines_.next(line)) {
      if (!line.empty() && line.back() == '\\') {
        join_lines(line);
        line = joined_;
      }
      statement(line);
    }
    end_object();
    if (objects_.empty() && groups_.empty()) {
      if (vertices_.empty()) throw InputError(file_.string(), "no vertices: this is no OBJ mesh, or it is cut off");
      throw InputError(file_.string(), fmt::format("{} vertices but no faces (points, lines and free-form surfaces are "
                                                   "not read)",
                                                   vertices_.size()));
    }
    std::vector<RawPart> all = parts();
    std::ranges::move(absent_, std::back_inserter(all));
    return all;
  }

 private:
  /// Names an object that has nothing but what is not read.
  void end_object() {
    const std::string name = object_.empty() ? file_.stem().string() : object_;
    if (surfaces_ && object_open_)
      context_.log(LogLevel::warning,
                   fmt::format("'{}' has free-form surfaces, which are not read, beside its faces", name));
    if ((surfaces_ || drawn_) && !object_open_) {
      RawPart& part = absent_.emplace_back();
      part.name = name;
      part.file = file_.filename().string();
      part.problem = surfaces_ ? "it has free-form surfaces, which are not read, and no faces" : "only points or lines";
      part.by_meaning = !surfaces_;
    }
    surfaces_ = drawn_ = false;
  }

  void join_lines(std::string_view line) {
    joined_.clear();
    bool more = true;
    while (more) {
      more = !line.empty() && line.back() == '\\';
      if (more) line.remove_suffix(1);
      joined_ += line;
      joined_ += ' ';
      if (joined_.size() > (1u << 24)) lines_.fail("the line goes on for too long");
      if (more && !lines_.next(line)) break;
    }
  }

  void statement(std::string_view line) {
    line = line.substr(0, line.find('#'));
    const std::string_view keyword = take_word(line);
    if (keyword == "v") {
      Eigen::Vector3d v;
      for (int k = 0; k < 3; ++k) v[k] = take_coordinate(line, lines_);
      if (vertices_.size() >= 0xfffffffeu) lines_.fail("too many vertices");
      vertices_.push_back(v);
    } else if (keyword == "f" || keyword == "fo") {
      face(line);
    } else if (keyword == "o") {
      // Two objects with one name are two parts.
      end_object();
      object_ = std::string(trimmed(line));
      object_open_ = false;
    } else if (keyword == "g") {
      group_ = std::string(trimmed(line));
    } else if (keyword == "usemtl") {
      material_ = std::string(trimmed(line));
    } else if (keyword == "mtllib") {
      libraries_.emplace_back(trimmed(line));
    } else if (keyword == "p" || keyword == "l") {
      drawn_ = true;
    } else if (keyword == "surf" || keyword == "bzp" || keyword == "bsp" || keyword == "cdp") {
      surfaces_ = true;
    } else if (keyword == "call") {
      lines_.fail("geometry in another file ('call') is not read");
    }
    // Everything else is no geometry of its own.
  }

  std::uint32_t index(std::string_view word) const {
    const std::string_view first = word.substr(0, word.find('/'));
    const auto value = to_integer(first);
    const auto count = static_cast<std::int64_t>(vertices_.size());
    if (!value) lines_.fail(fmt::format("'{}' is no vertex number", printable(word)));
    const std::int64_t i = *value > 0 ? *value - 1 : count + *value;
    if (*value == 0 || i < 0 || i >= count)
      lines_.fail(fmt::format("vertex {} does not exist: there are {} so far", *value, count));
    return static_cast<std::uint32_t>(i);
  }

  static std::string printable(std::string_view word) {
    std::string s(word.substr(0, 40));
    for (char& c : s)
      if (c < 0x20 || c > 0x7E) c = '?';
    return s;
  }

  void face(std::string_view rest) {
    corners_.clear();
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest))
      corners_.push_back(index(word));
    if (corners_.size() < 3) lines_.fail(fmt::format("a face needs three corners, this one has {}", corners_.size()));
    Section& here = section();
    if (here.materials.empty() || here.last_material != material_) {
      here.materials.insert(material_);
      here.last_material = material_;
    }
    auto& out = here.triangles;
    if (corners_.size() == 3) {
      out.push_back({corners_[0], corners_[1], corners_[2]});
      return;
    }
    points_.clear();
    for (const auto i : corners_) points_.push_back(vertices_[i]);
    const auto cut = triangulate_polygon(points_);
    for (const auto& t : cut) out.push_back({corners_[t[0]], corners_[t[1]], corners_[t[2]]});
    if (cut.empty())  // self-intersecting or without area: a fan keeps the surface closed
      for (std::size_t i = 2; i < corners_.size(); ++i) out.push_back({corners_[0], corners_[i - 1], corners_[i]});
  }

  /// The section of the next faces. Objects and groups are both kept until the end of the file shows which are the
  /// parts.
  Section& section() {
    if (!object_open_) {
      objects_.push_back({object_, {}});
      object_open_ = true;
      groups_of_object_.clear();
    }
    const std::string key = object_ + '\n' + group_;
    const auto [it, fresh] = groups_of_object_.try_emplace(key, groups_.size());
    if (fresh) {
      groups_.push_back({group_, {}});
      object_of_group_.push_back(objects_.size() - 1);
    }
    return groups_[it->second];
  }

  std::vector<RawPart> parts() {
    if (objects_.size() > 1 || !objects_[0].name.empty()) {
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        auto& to = objects_[object_of_group_[g]].triangles;
        to.insert(to.end(), groups_[g].triangles.begin(), groups_[g].triangles.end());
        objects_[object_of_group_[g]].materials.insert(groups_[g].materials.begin(), groups_[g].materials.end());
      }
      // A single object around all groups names the file, not a part.
      if (objects_.size() == 1 && groups_.size() > 1) return built(groups_, objects_[0].name);
      return built(objects_);
    }
    return built(groups_);
  }

  /// The colours of all materials in the file's libraries, which are beside it.
  std::map<std::string, Rgba> colours() const {
    std::map<std::string, Rgba> all;
    for (const std::string& library : libraries_) {
      const std::filesystem::path name = file_.parent_path() / library;
      if (may_read_referenced(name, file_)) all.merge(read_material_library(name));
    }
    return all;
  }

  /// `object`: the object that contains the sections as groups; empty: none.
  std::vector<RawPart> built(const std::vector<Section>& sections, const std::string& object = {}) const {
    const std::map<std::string, Rgba> known = colours();
    std::vector<RawPart> parts;
    std::vector<std::uint32_t> local(vertices_.size(), 0), owner(vertices_.size(), 0xffffffffu);
    for (std::uint32_t s = 0; s < sections.size(); ++s) {
      RawPart part;
      part.name = sections[s].name;
      part.file = file_.filename().string();
      if (!object.empty()) part.parents = {object};
      OneColour colour;
      for (const std::string& material : sections[s].materials) {
        const auto found = known.find(material);
        colour.add(found == known.end() ? std::nullopt : std::optional(found->second));
      }
      part.colour = colour.get();
      for (Triangle t : sections[s].triangles) {
        for (auto& v : t) {
          if (owner[v] != s) {
            owner[v] = s;
            local[v] = static_cast<std::uint32_t>(part.mesh.vertices.size());
            part.mesh.vertices.push_back(vertices_[v]);
          }
          v = local[v];
        }
        part.mesh.triangles.push_back(t);
      }
      parts.push_back(std::move(part));
    }
    return parts;
  }

  std::filesystem::path file_;
  RunContext context_;
  LineReader lines_;
  std::string joined_;
  std::vector<Eigen::Vector3d> vertices_, points_;
  std::vector<std::uint32_t> corners_;
  std::string object_, group_, material_;
  std::vector<std::string> libraries_;
  bool object_open_ = false;
  bool surfaces_ = false, drawn_ = false;  // the object has free-form surfaces; points or lines
  std::vector<RawPart> absent_;
  std::vector<Section> objects_, groups_;
  std::vector<std::size_t> object_of_group_;
  std::unordered_map<std::string, std::size_t> groups_of_object_;
};

}  // namespace

std::vector<RawPart> read_obj(const std::filesystem::path& file, const RunContext& context) {
  return ObjReader(file, context).read();
}

std::optional<std::uint64_t> count_obj_triangles(const std::filesystem::path& file) {
  try {
    LineReader lines(file);
    std::uint64_t triangles = 0;
    std::string_view rest;
    while (lines.next(rest)) {
      if (take_word(rest) != "f") continue;
      std::uint64_t corners = 0;
      while (!take_word(rest).empty()) ++corners;
      triangles += corners > 2 ? corners - 2 : 0;
    }
    return triangles;
  } catch (const InputError&) {
    return std::nullopt;  // read_obj() reports the error
  }
}

}  // namespace dismantle::mesh_files
