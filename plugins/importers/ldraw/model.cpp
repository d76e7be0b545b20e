#include "model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include "dismantle/errors.h"
#include "part_mesh.h"

namespace dismantle::ldraw {
namespace {

constexpr double kMillimetres = 0.4;  // one LDraw unit

/// LDraw has -Y up; here Z is up.
Eigen::Vector3d out_of_ldraw(const Eigen::Vector3d& v) { return {v.x(), v.z(), -v.y()}; }

/// Is the file a part, and not a model of several? Files that state no type are what their place says.
bool is_part(const std::string& key, const Found& found) {
  std::string_view type = found.file->type;
  if (type.starts_with("Unofficial_")) type.remove_prefix(std::string_view("Unofficial_").size());
  if (type == "Part" || type == "Shortcut" || type == "Subpart" || type.ends_with("Primitive")) return true;
  if (!type.empty()) return false;
  return found.origin == Origin::parts || found.origin == Origin::primitives || key.ends_with(".dat");
}

std::optional<Rgba> rgba_of(const std::string& hex) {
  unsigned value = 0;
  if (hex.size() != 7 || hex[0] != '#') return std::nullopt;
  const auto [end, error] = std::from_chars(hex.data() + 1, hex.data() + 7, value, 16);
  if (error != std::errc() || end != hex.data() + 7) return std::nullopt;
  return Rgba{static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 255),
              static_cast<std::uint8_t>(value & 255), 255};
}

Eigen::Matrix3d turn_of(const Eigen::Vector3d& degrees) {
  const Eigen::Vector3d a = degrees * std::numbers::pi / 180;
  return (Eigen::AngleAxisd(a.x(), Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(a.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(a.z(), Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

/// How the thing lies when the view is turned like this: the axis that is nearest to what is up on the screen. Authors
/// tilt the view a little to show the top; that is no other position.
Eigen::Vector3d up_under(const Eigen::Matrix3d& view) {
  const Eigen::Vector3d up = view.transpose() * -Eigen::Vector3d::UnitY();
  Eigen::Index axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  return Eigen::Vector3d::Unit(axis) * (up[axis] < 0 ? -1 : 1);
}

/// Where a model stands in another one.
struct Place {
  Placement placement{};
  bool inverted = false;
  std::string colour = "16";
  std::vector<std::string> parents{};    // names of the models around it
  std::vector<std::string> instances{};  // their uses
  std::string group{};                   // name of the steps in which it is built
};

class Walk {
 public:
  Walk(Library& library, const RunContext& context) : library_(library), context_(context), meshes_(library) {}

  Model run() {
    const std::optional<Found> found = library_.find(library_.first());
    Place top;
    if (is_part(library_.first(), *found))
      add_part(library_.first(), *found, top);
    else
      model(library_.first(), *found->file, top);
    for (const auto& [hidden, place] : hidden_) add_hidden(hidden, place);
    return std::move(out_);
  }

 private:
  using Lines = std::set<std::pair<std::string_view, std::array<double, 12>>>;  // names and placements

  /// Adds all parts of a model; returns their indices.
  std::vector<std::uint32_t> model(const std::string& key, const LdrawFile& file, const Place& place) {
    if (context_.should_stop()) throw Error("stopped while reading LDraw files");
    if (!open_.insert(key).second || open_.size() > kDeepest) throw InputError(key, "this model refers to itself");
    std::vector<std::uint32_t> all, step_parts;
    unsigned step = 1;
    Eigen::Matrix3d view = Eigen::Matrix3d::Identity();
    auto end = file.steps.begin();
    const auto finish_steps = [&](std::size_t before) {
      for (; end != file.steps.end() && end->before <= before; ++end) {
        if (end->ends_turn) view.setIdentity();
        if (end->turn) {
          const Eigen::Matrix3d turn = turn_of(*end->turn);
          view = end->mode == "ADD" ? Eigen::Matrix3d(view * turn) : turn;
        }
        finish_step(step, step_parts, place, view);
      }
    };
    Lines earlier;
    auto bent = file.bent.begin();
    for (std::size_t i = 0; i < file.references.size(); ++i) {
      finish_steps(i);
      while (bent != file.bent.end() && bent->first < i) ++bent;
      if (bent != file.bent.end() && bent->first == i && is_one_part(file, *bent)) {
        step_parts.push_back(add_bent(file, *bent, place));
        all.push_back(step_parts.back());
        i = bent->end - 1;
        continue;
      }
      if (is_repeated(file.references[i], earlier)) {
        add_repeated(file.references[i], place);
        continue;
      }
      const std::vector<std::uint32_t> added = reference(file.references[i], place);
      step_parts.insert(step_parts.end(), added.begin(), added.end());
      all.insert(all.end(), added.begin(), added.end());
    }
    for (const Hidden& hidden : file.hidden) hidden_.emplace_back(hidden, place);
    if (!file.polygons.empty()) {  // a surface that the model has by itself
      RawPart part = raw(file.description.empty() ? key : file.description, place, key);
      add_polygons(file, place.placement, place.inverted, part.mesh);
      to_millimetres(part.mesh);
      step_parts.push_back(push(std::move(part)));
      all.push_back(step_parts.back());
    }
    finish_steps(file.references.size());
    finish_step(step, step_parts, place, view);
    open_.erase(key);
    return all;
  }

  /// Steps without parts, as they are common at the end of files, are none. The turn of a ROTSTEP is that of its step.
  void finish_step(unsigned& step, std::vector<std::uint32_t>& parts, const Place& place, const Eigen::Matrix3d& view) {
    if (parts.empty()) return;
    std::sort(parts.begin(), parts.end());
    const Eigen::Vector3d up = (place.placement.linear * up_under(view)).normalized();
    out_.order.push_back({step++, std::exchange(parts, {}), place.group, out_of_ldraw(up)});
  }

  std::vector<std::uint32_t> reference(const Reference& r, const Place& place) {
    if (++used_ > kMostUses) throw too_many();
    Place inner = place;
    inner.placement = place.placement * r.placement;
    inner.inverted = place.inverted != r.inverted;
    if (r.colour != "16") inner.colour = r.colour;
    const std::optional<Found> found = library_.find(r.name);
    if (!found) {
      RawPart missing = raw(r.name, inner, r.name);
      missing.problem = library_.why_missing(r.name);
      push(std::move(missing));
      return {};
    }
    if (is_part(r.name, *found)) return {add_part(r.name, *found, inner)};
    inner.group = unique_group(r.name);
    inner.parents.push_back(r.name);
    inner.instances.push_back(inner.group);
    return model(r.name, *found->file, inner);
  }

  /// Are the segments one part, as those of a hose are? The links of a chain or a tread are parts of their own.
  bool is_one_part(const LdrawFile& file, const Bent& bent) {
    for (std::size_t i = bent.first; i < bent.end; ++i) {
      const std::string& key = file.references[i].name;
      const std::optional<Found> found = library_.find(key);
      if (!found || !is_part(key, *found) || !meshes_.of(key).problem.empty()) return false;
      if (name_key(described(*found->file).description).starts_with("technic chain")) return false;
    }
    return true;
  }

  std::uint32_t add_bent(const LdrawFile& file, const Bent& bent, const Place& place) {
    const Reference& first = file.references[bent.first];
    std::string name = bent.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    if (name.empty()) name = file.description.empty() ? file.name : file.description;
    Place inner = place;
    if (first.colour != "16") inner.colour = first.colour;
    RawPart part = raw(name, inner, bent.name.empty() ? name_key(file.name) : bent.name);
    part.flexible = true;
    for (std::size_t i = bent.first; i < bent.end; ++i) {
      const Reference& r = file.references[i];
      if (++used_ > kMostUses) throw too_many();
      add_mesh(meshes_.of(r.name).mesh, place.placement * r.placement, place.inverted != r.inverted, part.mesh);
    }
    to_millimetres(part.mesh);
    return push(std::move(part));
  }

  /// Is the line written a second time: the same part in the same place, of the same model?
  bool is_repeated(const Reference& r, Lines& earlier) {
    std::array<double, 12> place;
    Eigen::Map<Eigen::Matrix3d>(place.data()) = r.placement.linear;
    Eigen::Map<Eigen::Vector3d>(place.data() + 9) = r.placement.shift;
    if (earlier.emplace(r.name, place).second) return false;
    const std::optional<Found> found = library_.find(r.name);
    return found && is_part(r.name, *found);
  }

  /// Two parts cannot be in one place, so the line is a slip of the author, and the part is there once.
  void add_repeated(const Reference& r, const Place& place) {
    RawPart part = raw(name_of(r.name, *library_.find(r.name)->file), place, r.name);
    part.problem = "the model has the same line twice: the same part in the same place";
    part.by_meaning = true;
    push(std::move(part));
  }

  void add_hidden(const Hidden& hidden, const Place& place) {
    const std::optional<Found> found = library_.find(hidden.reference.name);
    RawPart part =
        raw(found ? name_of(hidden.reference.name, *found->file) : hidden.reference.name, place, hidden.reference.name);
    part.problem = hidden.why;
    part.by_meaning = true;
    push(std::move(part));
  }

  /// The file that describes a part; of one that only says where a part has moved to, that of the part.
  const LdrawFile& described(const LdrawFile& file) {
    const LdrawFile* of = &file;
    std::optional<Found> next;
    for (std::size_t hops = 0; of->description.starts_with("~Moved to") && of->references.size() == 1; ++hops) {
      if (hops == kDeepest || !(next = library_.find(of->references.front().name))) break;
      of = next->file;
    }
    return *of;
  }

  std::string name_of(const std::string& key, const LdrawFile& file) {
    const std::string& description = described(file).description;
    return description.empty() ? key : description;
  }

  /// Tyres are of rubber, whatever colour a model gives them.
  bool is_tyre(const LdrawFile& file) {
    const LdrawFile& of = described(file);
    std::string category = of.category.empty() ? of.description.substr(0, of.description.find(' ')) : of.category;
    category.erase(0, category.find_first_not_of("~_=|"));  // marks of parts that are no longer used, and the like
    return name_key(category) == "tyre";
  }

  std::uint32_t add_part(const std::string& key, const Found& found, const Place& place) {
    RawPart part = raw(name_of(key, *found.file), place, key);
    part.flexible = part.flexible || is_tyre(*found.file);
    const PartMesh& shape = meshes_.of(key);
    part.problem = shape.problem;
    const double volume = place.placement.linear.determinant();
    if (part.problem.empty() && std::abs(volume) < 1e-9) part.problem = "its placement has no volume";
    if (part.problem.empty()) {
      add_mesh(shape.mesh, place.placement, place.inverted, part.mesh);
      to_millimetres(part.mesh);
    }
    return push(std::move(part));
  }

  RawPart raw(const std::string& name, const Place& place, const std::string& key) {
    RawPart part;
    part.name = name;
    part.unit = "mm";
    part.parents = place.parents;
    part.instances = place.instances;
    part.instances.push_back(fmt::format("{}#{}", key, ++uses_[key]));
    part.product = name;
    if (const Colour* colour = library_.colour(place.colour)) {
      part.colour = rgba_of(colour->value);
      part.flexible = colour->rubber;
    }
    return part;
  }

  std::uint32_t push(RawPart part) {
    out_.parts.push_back(std::move(part));
    return static_cast<std::uint32_t>(out_.parts.size() - 1);
  }

  std::string unique_group(const std::string& key) {
    const unsigned n = ++groups_[key];
    return n == 1 ? key : fmt::format("{}#{}", key, n);
  }

  InputError too_many() {
    return {library_.first(), fmt::format("it has more than {} parts and sub-models", kMostUses)};
  }

  static void add_mesh(const Mesh& mesh, const Placement& placement, bool inverted, Mesh& out) {
    const auto base = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.reserve(out.vertices.size() + mesh.vertices.size());
    for (const Eigen::Vector3d& v : mesh.vertices) out.vertices.push_back(placement.linear * v + placement.shift);
    const bool turned = (placement.linear.determinant() < 0) != inverted;
    for (const Triangle& t : mesh.triangles)
      out.triangles.push_back({base + t[0], base + t[turned ? 2 : 1], base + t[turned ? 1 : 2]});
  }

  static void to_millimetres(Mesh& mesh) {
    for (Eigen::Vector3d& v : mesh.vertices) v = kMillimetres * out_of_ldraw(v);
  }

  Library& library_;
  const RunContext& context_;
  PartMeshes meshes_;
  Model out_;
  std::vector<std::pair<Hidden, Place>> hidden_;  // they come last: others keep their numbers
  std::set<std::string> open_;
  std::size_t used_ = 0;
  std::map<std::string, unsigned> uses_, groups_;
};

}  // namespace

Model model_of(Library& library, const RunContext& context) { return Walk(library, context).run(); }

}  // namespace dismantle::ldraw
