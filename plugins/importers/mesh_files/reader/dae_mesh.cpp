#include "dae_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "dismantle/geometry/mesh_measure.h"
#include "input_limits.h"
#include "text_scan.h"

namespace dismantle::mesh_files {
namespace {

using Fail = std::function<void(const std::string&)>;

/// A document refers to its own elements by '#' and their id.
std::string own_id(const std::string& reference) { return reference.starts_with('#') ? reference.substr(1) : ""; }

std::size_t whole(const XmlElement& element, const char* attribute, std::size_t otherwise, const Fail& fail) {
  const std::string text = element.get(attribute);
  if (text.empty()) return otherwise;
  const auto value = to_integer(text);
  if (!value || *value < 0 || *value > 0xffffffffLL)
    fail(fmt::format("<{}> has '{}' as its {}", element.name, text, attribute));
  return static_cast<std::size_t>(*value);
}

class MeshReader {
 public:
  MeshReader(const XmlElement& geometry, const Fail& fail)
      : id_(geometry.get("id")),
        fail_([&fail, id = id_](const std::string& what) { fail(fmt::format("geometry '{}': {}", id, what)); }) {}

  DaeMesh read(const XmlElement& mesh) {
    find_positions(mesh);
    for (const auto& element : mesh.children) {
      if (element->name == "lines" || element->name == "linestrips")
        out_.drawn = true;
      else if (element->name == "triangles" || element->name == "polylist" || element->name == "polygons" ||
               element->name == "tristrips" || element->name == "trifans")
        add(*element);
    }
    return std::move(out_);
  }

 private:
  const XmlElement& by_id(const XmlElement& mesh, const std::string& reference) const {
    const std::string id = own_id(reference);
    for (const auto& element : mesh.children)
      if (!id.empty() && element->get("id") == id) return *element;
    fail_(fmt::format("it refers to '{}', which it has not", reference));
    return mesh;
  }

  void find_positions(const XmlElement& mesh) {
    const XmlElement* vertices = mesh.child("vertices");
    if (vertices == nullptr) return;
    for (const auto& input : vertices->children) {
      if (input->get("semantic") != "POSITION") continue;
      const XmlElement& source = by_id(mesh, input->get("source"));
      const XmlElement* array = source.child("float_array");
      const XmlElement* accessor = source.find({"technique_common", "accessor"});
      if (array == nullptr || accessor == nullptr) return fail_("its positions have no array or no accessor");
      const std::vector<double> numbers = dae_numbers(*array, fail_);
      const std::size_t count = whole(*accessor, "count", 0, fail_), stride = whole(*accessor, "stride", 1, fail_),
                        offset = whole(*accessor, "offset", 0, fail_);
      if (stride < 3 || numbers.size() < offset || (numbers.size() - offset + stride - 3) / stride < count)
        return fail_(fmt::format("it states {} positions and has {} numbers", count, numbers.size()));
      for (std::size_t i = 0; i < count; ++i)
        out_.vertices.emplace_back(numbers[offset + i * stride], numbers[offset + i * stride + 1],
                                   numbers[offset + i * stride + 2]);
      vertices_id_ = vertices->get("id");
    }
  }

  /// Positions of the corners of one primitive, from a list of indices of all inputs.
  std::vector<std::uint32_t> corners(const XmlElement& p, std::size_t offset, std::size_t stride) const {
    std::vector<std::uint32_t> out;
    std::string_view rest = p.text;
    std::size_t at = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++at) {
      if (at % stride != offset) continue;
      const auto index = to_integer(word);
      if (!index || *index < 0 || *index >= static_cast<std::int64_t>(out_.vertices.size()))
        fail_(fmt::format("a face names vertex '{}' of {}", word, out_.vertices.size()));
      out.push_back(static_cast<std::uint32_t>(*index));
    }
    if (at % stride != 0) fail_(fmt::format("{} indices for corners of {} each", at, stride));
    return out;
  }

  void add(const XmlElement& element) {
    const std::size_t count = whole(element, "count", 0, fail_);
    std::optional<std::size_t> offset;
    std::size_t stride = 1;
    for (const auto& input : element.children) {
      if (input->name != "input") continue;
      const std::size_t own = whole(*input, "offset", 0, fail_);
      if (own > 1000) fail_("an input has a large offset");
      stride = std::max(stride, own + 1);
      if (input->get("semantic") == "VERTEX" && own_id(input->get("source")) == vertices_id_) offset = own;
    }
    std::vector<std::vector<std::uint32_t>> lists;
    for (const auto& p : element.children) {
      if (p->name == "ph") out_.problem = "it has polygons with holes, which are not read";
      if (p->name == "p" && !offset) fail_("faces without positions");
      if (p->name == "p") lists.push_back(corners(*p, *offset, stride));
    }
    if (out_.groups.empty() || out_.groups.back().material != element.get("material"))
      out_.groups.push_back({element.get("material"), {}});
    const bool polygons = element.name == "polygons", strips = element.name == "tristrips";
    if (polygons || strips || element.name == "trifans") {
      if (lists.size() != count && out_.problem.empty())
        fail_(fmt::format("it states {} {} and has {}", count, element.name, lists.size()));
      for (const auto& list : lists) polygons ? polygon(list) : strips ? strip(list) : fan(list);
      return;
    }
    std::vector<std::uint32_t> all;
    for (const auto& list : lists) all.insert(all.end(), list.begin(), list.end());
    std::vector<double> sizes(count, 3);
    if (element.name == "polylist") {
      const XmlElement* vcount = element.child("vcount");
      sizes = vcount != nullptr ? dae_numbers(*vcount, fail_) : std::vector<double>();
    }
    cut(all, sizes, count, element.name);
  }

  void cut(const std::vector<std::uint32_t>& all, const std::vector<double>& sizes, std::size_t count,
           const std::string& name) {
    std::size_t at = 0;
    for (const double size : sizes) {
      if (!(size >= 0) || size > static_cast<double>(all.size() - at)) {
        at = all.size() + 1;
        break;
      }
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(at);
      at += static_cast<std::size_t>(size);
      polygon({first, all.begin() + static_cast<std::ptrdiff_t>(at)});
    }
    if (at != all.size() || sizes.size() != count)
      fail_(fmt::format("it states {} faces of <{}>, and its {} indices are others", count, name, all.size()));
  }

  void polygon(const std::vector<std::uint32_t>& c) {
    if (c.size() < 4) return fan(c);
    std::vector<Eigen::Vector3d> points;
    for (const auto i : c) points.push_back(out_.vertices[i]);
    const auto cut = triangulate_polygon(points);
    for (const auto& t : cut) add({c[t[0]], c[t[1]], c[t[2]]});
    if (cut.empty()) fan(c);  // self-intersecting or without area: a fan keeps the surface closed
  }

  void fan(const std::vector<std::uint32_t>& c) {
    for (std::size_t i = 2; i < c.size(); ++i) add({c[0], c[i - 1], c[i]});
  }

  void strip(const std::vector<std::uint32_t>& c) {
    for (std::size_t i = 2; i < c.size(); ++i)
      i % 2 == 0 ? add({c[i - 2], c[i - 1], c[i]}) : add({c[i - 1], c[i - 2], c[i]});
  }

  void add(const Triangle& t) {
    out_.groups.back().triangles.push_back(t);
    if (++total_ > reader_process::kInputLimits.triangles)
      fail_(fmt::format("more than {} triangles", reader_process::kInputLimits.triangles));
  }

  std::string id_, vertices_id_;
  Fail fail_;
  DaeMesh out_;
  std::uint64_t total_ = 0;
};

}  // namespace

bool DaeMesh::has_triangles() const {
  return std::ranges::any_of(groups, [](const Group& g) { return !g.triangles.empty(); });
}

std::vector<double> dae_numbers(const XmlElement& element, const Fail& fail) {
  std::vector<double> out;
  std::string_view rest = element.text;
  for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
    const auto value = to_double(word);
    if (!value) fail(fmt::format("'{}' in <{}> is no number", word.substr(0, 40), element.name));
    out.push_back(*value);
  }
  return out;
}

DaeMesh read_dae_mesh(const XmlElement& geometry, const Fail& fail) {
  if (const XmlElement* mesh = geometry.child("mesh")) return MeshReader(geometry, fail).read(*mesh);
  DaeMesh out;
  out.drawn = geometry.child("spline") != nullptr;
  for (const char* kind : {"convex_mesh", "brep"})
    if (geometry.child(kind) != nullptr) out.problem = fmt::format("its shape is a <{}>, which is not read", kind);
  return out;
}

}  // namespace dismantle::mesh_files
