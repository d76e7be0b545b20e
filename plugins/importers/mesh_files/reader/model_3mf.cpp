#include "model_3mf.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/geometry/length_unit.h"
#include "text_scan.h"
#include "xml_events.h"

namespace dismantle::mesh_files {
namespace {

constexpr std::string_view kProduction = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";

/// Extensions that a model may require: what they add is read, or changes no shape.
bool namespace_is_known(std::string_view space) {
  return space == kProduction || space.find("/material/") != space.npos || space.find("/trianglesets/") != space.npos;
}

std::string without_slash(std::string_view path) {
  while (path.starts_with('/')) path.remove_prefix(1);
  return std::string(path);
}

class ModelParser {
 public:
  ModelParser(const std::filesystem::path& file, const std::string& name) : file_(file), name_(name) {
    xml_.start = [this](const XmlTag& tag) { start(tag); };
    xml_.end = [this] { --depth_; };
  }

  Model3mf read(reader_process::ZipArchive& archive) {
    try {
      archive.read(name_, [this](std::string_view bytes) { xml_.feed(bytes); });
      xml_.feed({}, true);
    } catch (const std::runtime_error& e) {
      if (dynamic_cast<const InputError*>(&e) != nullptr) throw;
      throw InputError(file_.string(), fmt::format("{}: {}", name_, e.what()));
    }
    return std::move(model_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(file_.string(), fmt::format("{}: line {}: {}", name_, xml_.line(), problem));
  }

  void start(const XmlTag& tag) {
    if (depth_++ == 0) return start_model(tag);
    if (tag.space != core_) return start_extension(tag);
    if (tag.name == "vertex")
      add_vertex(tag);
    else if (tag.name == "triangle")
      add_triangle(tag);
    else if (tag.name == "object")
      start_object(tag);
    else if (tag.name == "component")
      object().components.push_back(placed(tag));
    else if (tag.name == "item")
      model_.items.push_back(placed(tag));
    else if (tag.name == "basematerials")
      colours_ = &groups_[needed(tag, "id")];
    else if (tag.name == "base" && colours_ != nullptr)
      colours_->push_back(colour(tag.find("displaycolor")));
  }

  void start_model(const XmlTag& tag) {
    if (tag.name != "model") fail("this is no 3MF model");
    core_ = tag.space;
    if (const auto unit = tag.find("unit")) {
      model_.unit = unit_named(*unit);
      if (model_.unit.empty()) fail(fmt::format("length unit '{}' is not known", *unit));
    }
    std::string_view required = tag.find("requiredextensions").value_or("");
    for (std::string_view prefix = take_word(required); !prefix.empty(); prefix = take_word(required)) {
      const auto found = xml_.prefixes.find(std::string(prefix));
      const std::string space = found == xml_.prefixes.end() ? std::string(prefix) : found->second;
      if (!namespace_is_known(space))
        fail(fmt::format("it requires the extension '{}' ({}), which is not read: export it without", prefix, space));
    }
  }

  /// Colours of the materials extension, and beams.
  void start_extension(const XmlTag& tag) {
    if (tag.name == "colorgroup")
      colours_ = &groups_[needed(tag, "id")];
    else if (tag.name == "color" && colours_ != nullptr)
      colours_->push_back(colour(tag.find("color")));
    else if (tag.name == "beamlattice")
      object().beams = true;
  }

  void start_object(const XmlTag& tag) {
    const std::string id = needed(tag, "id");
    const auto [it, fresh] = model_.objects.try_emplace(id);
    if (!fresh) fail(fmt::format("two objects have the id {}", id));
    model_.order.push_back(id);
    object_ = &it->second;
    object_->name = tag.find("name").value_or("");
    object_->type = tag.find("type").value_or("model");
    colours_ = nullptr;
    own_colour_ = property(tag.find("pid"), tag.find("pindex"), std::nullopt);
    own_group_ = std::string(tag.find("pid").value_or(""));
  }

  Object3mf& object() {
    if (object_ == nullptr) fail("this element belongs into an object");
    return *object_;
  }

  std::string needed(const XmlTag& tag, std::string_view name) const {
    const auto value = tag.find(name);
    if (!value || value->empty()) fail(fmt::format("<{}> needs '{}'", tag.name, name));
    return std::string(*value);
  }

  double coordinate(const XmlTag& tag, std::string_view name) const {
    const auto value = tag.find(name);
    const auto number = value ? to_double(trimmed(*value)) : std::nullopt;
    if (!number || !std::isfinite(*number)) fail(fmt::format("<{}> needs a finite number '{}'", tag.name, name));
    return *number;
  }

  void add_vertex(const XmlTag& tag) {
    auto& vertices = object().mesh.vertices;
    if (vertices.size() >= 0xfffffffeu) fail("too many vertices");
    vertices.emplace_back(coordinate(tag, "x"), coordinate(tag, "y"), coordinate(tag, "z"));
  }

  void add_triangle(const XmlTag& tag) {
    Mesh& mesh = object().mesh;
    Triangle t{};
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr std::array<std::string_view, 3> names{"v1", "v2", "v3"};
      const auto value = to_integer(trimmed(tag.find(names[k]).value_or("")));
      if (!value || *value < 0 || static_cast<std::uint64_t>(*value) >= mesh.vertices.size())
        fail(fmt::format("vertex '{}' does not exist, there are {}", tag.find(names[k]).value_or(""),
                         mesh.vertices.size()));
      t[k] = static_cast<std::uint32_t>(*value);
    }
    mesh.triangles.push_back(t);
    object().colour.add(property(tag.find("pid"), tag.find("p1"), own_colour_));
  }

  /// Colour number `index` of a group; `otherwise` where there is no index.
  std::optional<Rgba> property(std::optional<std::string_view> group, std::optional<std::string_view> index,
                               const std::optional<Rgba>& otherwise) const {
    if (!index) return otherwise;
    const auto found = groups_.find(group ? std::string(*group) : own_group_);
    const auto i = to_integer(*index);
    if (found == groups_.end() || !i || *i < 0 || static_cast<std::uint64_t>(*i) >= found->second.size())
      return std::nullopt;
    return found->second[static_cast<std::size_t>(*i)];
  }

  /// "#RRGGBB" or "#RRGGBBAA", sRGB.
  static std::optional<Rgba> colour(std::optional<std::string_view> text) {
    if (!text || (text->size() != 7 && text->size() != 9) || !text->starts_with('#')) return std::nullopt;
    std::array<std::uint8_t, 4> bytes{0, 0, 0, 255};
    for (std::size_t i = 1; i < text->size(); ++i) {
      const auto digit = std::string_view("0123456789abcdef").find(lower_case(text->substr(i, 1)));
      if (digit == std::string_view::npos) return std::nullopt;
      std::uint8_t& byte = bytes[(i - 1) / 2];
      byte = static_cast<std::uint8_t>(i % 2 == 1 ? digit << 4 : byte | digit);
    }
    return Rgba{bytes[0], bytes[1], bytes[2], bytes[3]};
  }

  Placed3mf placed(const XmlTag& tag) const {
    Placed3mf out;
    out.object = needed(tag, "objectid");
    for (const char** a = tag.attributes; *a != nullptr; a += 2) {  // the model file that holds the object
      const std::string_view name = *a;
      if (!name.ends_with("|path")) continue;
      if (name.substr(0, name.rfind('|')) != kProduction)
        fail(fmt::format("a path of the extension {}, which is not read", name.substr(0, name.rfind('|'))));
      out.path = without_slash(a[1]);
    }
    const auto transform = tag.find("transform");
    if (!transform) return out;
    std::string_view rest = *transform;
    for (int i = 0; i < 12; ++i) {  // row by row, of a matrix that multiplies rows from the right
      const auto value = to_double(take_word(rest));
      if (!value || !std::isfinite(*value)) fail("a transform is twelve finite numbers");
      out.place.matrix()(i % 3, i / 3) = *value;
    }
    if (!trimmed(rest).empty()) fail("a transform is twelve finite numbers");
    if (out.place.linear().determinant() == 0) fail("a transform flattens what it places");
    return out;
  }

  const std::filesystem::path& file_;
  const std::string& name_;
  XmlEvents xml_;
  Model3mf model_;
  std::string core_, own_group_;  // name space of the core specification; property group of the object
  int depth_ = 0;
  Object3mf* object_ = nullptr;
  std::map<std::string, std::vector<std::optional<Rgba>>> groups_;
  std::vector<std::optional<Rgba>>* colours_ = nullptr;
  std::optional<Rgba> own_colour_;
};

}  // namespace

Model3mf read_model_3mf(reader_process::ZipArchive& archive, const std::filesystem::path& file,
                        const std::string& name) {
  return ModelParser(file, name).read(archive);
}

std::string target_3mf(reader_process::ZipArchive& archive, const std::filesystem::path& file, const std::string& rels,
                       const std::string& type) {
  std::string target;
  if (!archive.holds(rels)) return target;
  XmlEvents xml;
  xml.start = [&](const XmlTag& tag) {
    if (target.empty() && tag.name == "Relationship" && tag.find("Type").value_or("").ends_with(type))
      target = without_slash(tag.find("Target").value_or(""));
  };
  try {
    archive.read(rels, [&](std::string_view bytes) { xml.feed(bytes); });
    xml.feed({}, true);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& e) {
    throw InputError(file.string(), fmt::format("{}: {}", rels, e.what()));
  }
  return target;
}

}  // namespace dismantle::mesh_files
