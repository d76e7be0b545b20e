// DAE: nodes, their places, and the account of what they use.
#include "dae.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "appearance.h"
#include "dae_mesh.h"
#include "dismantle/errors.h"
#include "dismantle/geometry/length_unit.h"
#include "input_limits.h"
#include "text_scan.h"
#include "without_unused.h"
#include "xml_tree.h"

namespace dismantle::mesh_files {
namespace {

constexpr std::size_t kDeepest = 200;  // levels of nodes; they are walked by recursion

class DaeReader {
 public:
  explicit DaeReader(const std::filesystem::path& file) : file_(file), document_(read_xml(file)) {}

  PartsOfFile read() {
    if (document_.name != "COLLADA") fail("this is no .dae file: it does not begin with <COLLADA>");
    index(document_);
    find_unit();
    const XmlElement* use = document_.find({"scene", "instance_visual_scene"});
    if (use == nullptr) fail("it shows no scene");
    const XmlElement* scene = own(*use, "visual_scene");
    if (scene == nullptr) fail(fmt::format("the scene that it shows, '{}', is not in it", use->get("url")));
    if (const Below all = below(*scene); all.nodes > reader_process::kInputLimits.instances)
      fail(fmt::format("more than {} nodes", reader_process::kInputLimits.instances));
    else if (all.levels > kDeepest)
      fail(fmt::format("nodes nested more than {} deep", kDeepest));
    visit_children(*scene, Eigen::Matrix4d::Identity(), {{}, {"0"}, false});
    note_unused();
    if (out_.parts.empty()) fail("no triangles");
    return std::move(out_);
  }

 private:
  struct Path {
    std::vector<std::string> parents;    ///< names of nodes
    std::vector<std::string> instances;  ///< ids of nodes; one more: that of the file
    bool hidden = false;
  };

  [[noreturn]] void fail(const std::string& problem) const { throw InputError(file_.string(), problem); }

  void index(const XmlElement& element) {
    if (const std::string id = element.get("id"); !id.empty()) {
      const auto [it, fresh] = by_id_.try_emplace({element.name, id}, &element);
      if (!fresh) ambiguous_.insert(it->first);
    }
    for (const auto& child : element.children) index(*child);
  }

  /// The element of that kind that `use` refers to; nullptr: the file has none.
  const XmlElement* own(const XmlElement& use, const char* kind, const char* attribute = "url") const {
    const std::string url = use.get(attribute);
    const auto found = url.starts_with('#') ? by_id_.find({kind, url.substr(1)}) : by_id_.end();
    if (found == by_id_.end()) return nullptr;
    if (ambiguous_.contains(found->first)) fail(fmt::format("several <{}> have the id '{}'", kind, url.substr(1)));
    return found->second;
  }

  void find_unit() {
    const XmlElement* unit = document_.find({"asset", "unit"});
    const std::string metres = unit == nullptr ? "" : unit->get("meter");
    const auto value = to_double(metres.empty() ? "1" : metres);
    if (!value) fail(fmt::format("its unit of length is '{}'", metres));
    unit_ = unit_of_length(*value);
    if (unit_.empty()) out_.warnings.push_back(fmt::format("its length unit of {} m is not known", *value));
  }

  static std::string name_of(const XmlElement& node) {
    for (const char* key : {"name", "id", "sid"})
      if (std::string text = node.get(key); !text.empty()) return text;
    return {};
  }

  static bool uses_geometry(const XmlElement& node) {
    return node.child("instance_geometry") != nullptr || node.child("instance_controller") != nullptr;
  }

  /// Whether a node is a named assembly. A node with a part's name only wraps it.
  bool groups(const XmlElement& node) const {
    const std::string name = name_of(node);
    if (name.empty() || uses_geometry(node)) return false;
    std::size_t count = 0;
    std::string below;
    for (const auto& child : node.children) {
      if (child->name == "node") below = name_of(*child);
      if (child->name == "instance_node")
        if (const XmlElement* used = own(*child, "node")) below = name_of(*used);
      count += child->name == "node" || child->name == "instance_node";
    }
    return count > 1 || (count == 1 && name != below);
  }

  static bool hides(const XmlElement& node) {
    for (const auto& extra : node.children)
      if (extra->name == "extra")
        for (const auto& technique : extra->children)
          if (const XmlElement* visible = technique->child("visibility"))
            if (trimmed(visible->text) == "0" || trimmed(visible->text) == "false") return true;
    return false;
  }

  struct Below {
    std::uint64_t nodes = 0, levels = 0;
  };

  /// What a node stands for, itself included, each node of the file looked at once: a few nodes that use each other
  /// can multiply. Numbers stop at the limits.
  Below below(const XmlElement& node) {
    if (const auto known = below_.find(&node); known != below_.end()) return known->second;
    if (!open_.insert(&node).second) fail(fmt::format("the node '{}' contains itself", name_of(node)));
    Below out{1, 1};
    for (const auto& child : node.children) {
      const XmlElement* used = child->name == "node" ? child.get() : nullptr;
      if (child->name == "instance_node") used = own(*child, "node");
      if (used == nullptr) continue;
      if (open_.size() > kDeepest) fail(fmt::format("nodes nested more than {} deep", kDeepest));
      const Below more = below(*used);
      out.nodes = std::min<std::uint64_t>(out.nodes + more.nodes, reader_process::kInputLimits.instances + 1);
      out.levels = std::max(out.levels, more.levels + 1);
    }
    open_.erase(&node);
    return below_[&node] = out;
  }

  void visit_children(const XmlElement& node, const Eigen::Matrix4d& to_world, const Path& path) {
    for (const auto& child : node.children)
      if (child->name == "node") visit(*child, to_world, path);
    for (const auto& child : node.children) {
      if (child->name != "instance_node") continue;
      const std::string url = child->get("url");
      if (const XmlElement* used = own(*child, "node"))
        visit(*used, to_world, path);
      else
        leave_out(!name_of(*child).empty() ? name_of(*child) : name_of(node), path.parents,
                  fmt::format("it uses the node '{}', which {}", url, absence(url)), false);
    }
  }

  static const char* absence(const std::string& url) {
    return url.starts_with('#') ? "the file lacks" : "is in another file: these are not read";
  }

  void visit(const XmlElement& node, const Eigen::Matrix4d& above, const Path& path) {
    const std::string id = std::to_string(++visited_);
    const Eigen::Matrix4d to_world = above * place_of(node);
    Path below = path;
    below.hidden = path.hidden || hides(node);
    add(node, to_world, below, id);
    if (groups(node)) {
      below.parents.push_back(name_of(node));
      below.instances.push_back(id);
    }
    visit_children(node, to_world, below);
    seen_.insert(&node);
  }

  Eigen::Matrix4d place_of(const XmlElement& node) const {
    Eigen::Matrix4d out = Eigen::Matrix4d::Identity();
    const auto failing = [this](const std::string& what) { fail(what); };
    for (const auto& step : node.children) {
      const auto numbers = [&](std::size_t count) {
        const std::vector<double> n = dae_numbers(*step, failing);
        if (n.size() != count)
          fail(fmt::format("node '{}': <{}> has {} numbers, not {}", name_of(node), step->name, n.size(), count));
        return n;
      };
      Eigen::Affine3d here = Eigen::Affine3d::Identity();
      if (step->name == "matrix") {
        const std::vector<double> n = numbers(16);
        out *= Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(n.data());
        continue;
      }
      if (step->name == "translate") {
        here.translate(Eigen::Map<const Eigen::Vector3d>(numbers(3).data()));
      } else if (step->name == "scale") {
        here.scale(Eigen::Map<const Eigen::Vector3d>(numbers(3).data()));
      } else if (step->name == "rotate") {
        const std::vector<double> n = numbers(4);
        const Eigen::Vector3d axis(n[0], n[1], n[2]);
        if (axis.norm() > 0) here.rotate(Eigen::AngleAxisd(n[3] * std::numbers::pi / 180, axis.normalized()));
      } else if (step->name == "lookat") {  // eye, point looked at, up; it looks along -Z
        const std::vector<double> n = numbers(9);
        const Eigen::Map<const Eigen::Vector3d> eye(&n[0]), interest(&n[3]), up(&n[6]);
        here.translation() = eye;
        here.linear().col(2) = (eye - interest).normalized();
        here.linear().col(0) = up.cross(here.linear().col(2)).normalized();
        here.linear().col(1) = here.linear().col(2).cross(here.linear().col(0));
      } else if (step->name == "skew") {
        fail(fmt::format("node '{}' is placed by a <skew>, which is not read", name_of(node)));
      }
      out *= here.matrix();
    }
    return out;
  }

  const DaeMesh& mesh_of(const XmlElement& geometry) {
    const auto [it, fresh] = meshes_.try_emplace(&geometry);
    if (fresh) it->second = read_dae_mesh(geometry, [this](const std::string& what) { fail(what); });
    return it->second;
  }

  RawPart raw(const std::string& name, const std::vector<std::string>& parents) const {
    RawPart part;
    part.name = name;
    part.file = file_.filename().string();
    part.unit = unit_;
    part.parents = parents;
    return part;
  }

  void leave_out(const std::string& name, const std::vector<std::string>& parents, std::string problem,
                 bool by_meaning) {
    RawPart part = raw(name, parents);
    part.problem = std::move(problem);
    part.by_meaning = by_meaning;
    out_.parts.push_back(std::move(part));
  }

  /// All geometry of one node is one part: formats split it only by material.
  void add(const XmlElement& node, const Eigen::Matrix4d& to_world, const Path& path, const std::string& id) {
    RawPart part = raw(name_of(node), path.parents);
    part.instances = path.instances;
    part.instances.push_back(id);
    OneColour colour;
    bool used = false, drawn = false, named = false;
    for (const auto& use : node.children) {
      const bool controller = use->name == "instance_controller";
      if (!controller && use->name != "instance_geometry") continue;
      used = true;
      const std::string url = use->get("url");
      const XmlElement* found = own(*use, controller ? "controller" : "geometry");
      if (found != nullptr) seen_.insert(found);
      if (part.name.empty()) part.name = found != nullptr ? name_of(*found) : url;
      if (path.hidden) continue;
      std::string problem;
      if (found == nullptr)
        problem = fmt::format("it uses '{}', which {}", url, absence(url));
      else if (controller)
        problem = "it is deformed by a skin or a morph, which is not read";
      else if (problem = mesh_of(*found).problem; problem.empty())
        append(mesh_of(*found), *use, part.mesh, colour);
      if (!problem.empty()) leave_out(part.name, path.parents, problem, false);
      named = named || !problem.empty();
      drawn = drawn || (found != nullptr && !controller && mesh_of(*found).drawn);
    }
    if (!used) return;
    if (path.hidden) return leave_out(part.name, path.parents, "it is hidden in the file", true);
    if (!part.mesh.triangles.empty()) return place(std::move(part), colour, to_world);
    if (!named) leave_out(part.name, path.parents, drawn ? "only points or lines" : "it has no triangles", drawn);
  }

  void append(const DaeMesh& from, const XmlElement& use, Mesh& to, OneColour& colour) const {
    const auto base = static_cast<std::uint32_t>(to.vertices.size());
    to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
    for (const DaeMesh::Group& group : from.groups) {
      for (const Triangle& t : group.triangles) to.triangles.push_back({base + t[0], base + t[1], base + t[2]});
      if (!group.triangles.empty()) colour.add(colour_of(use, group.material));
    }
  }

  std::optional<Rgba> colour_of(const XmlElement& use, const std::string& symbol) const {
    const XmlElement* bound = use.find({"bind_material", "technique_common"});
    if (bound == nullptr) return std::nullopt;
    for (const auto& instance : bound->children) {
      if (instance->get("symbol") != symbol) continue;
      const XmlElement* material = own(*instance, "material", "target");
      const XmlElement* effect_use = material == nullptr ? nullptr : material->child("instance_effect");
      const XmlElement* effect = effect_use == nullptr ? nullptr : own(*effect_use, "effect");
      const XmlElement* technique = effect == nullptr ? nullptr : effect->find({"profile_COMMON", "technique"});
      if (technique == nullptr) return std::nullopt;
      for (const auto& shading : technique->children)
        if (const XmlElement* diffuse = shading->find({"diffuse", "color"})) {
          const auto n = dae_numbers(*diffuse, [this](const std::string& what) { fail(what); });
          return n.size() == 4 ? rgba(n[0], n[1], n[2], n[3], false) : std::nullopt;
        }
    }
    return std::nullopt;
  }

  void place(RawPart part, const OneColour& colour, const Eigen::Matrix4d& to_world) {
    const Eigen::Matrix3d linear = to_world.topLeftCorner<3, 3>();
    if (linear.isZero(0)) return leave_out(part.name, part.parents, "it is hidden by a scale of zero", true);
    if (linear.determinant() == 0) return leave_out(part.name, part.parents, "its place flattens it", false);
    part.product = part.name;
    part.colour = colour.get();
    part.mesh = without_unused(part.mesh);
    total_ += part.mesh.triangles.size();
    if (total_ > reader_process::kInputLimits.triangles)
      fail(fmt::format("more than {} triangles", reader_process::kInputLimits.triangles));
    for (std::size_t v = 0; v < part.mesh.vertices.size(); ++v) {
      Eigen::Vector3d& p = part.mesh.vertices[v];
      p = linear * p + to_world.topRightCorner<3, 1>();
      if (!p.allFinite()) fail(fmt::format("part '{}': vertex {} is not finite", part.name, v + 1));
    }
    if (linear.determinant() < 0)
      for (Triangle& t : part.mesh.triangles) std::swap(t[1], t[2]);
    out_.parts.push_back(std::move(part));
  }

  /// Nodes with geometry, and geometry, that the shown scene does not use.
  void note_unused() {
    std::set<std::string> sources;  // of skins and morphs
    const auto collect = [&](const auto& self, const XmlElement& element) -> void {
      if (element.name == "skin" || element.name == "morph") sources.insert(element.get("source"));
      for (const auto& child : element.children) self(self, *child);
    };
    collect(collect, document_);
    const auto visit_all = [&](const auto& self, const XmlElement& element) -> void {
      const bool node = element.name == "node" && uses_geometry(element);
      if (node && !seen_.contains(&element)) {
        leave_out(name_of(element), {}, "it is in no scene that the file shows", true);
        for (const auto& use : element.children)
          if (const XmlElement* geometry = own(*use, "geometry")) seen_.insert(geometry);
      }
      for (const auto& child : element.children) self(self, *child);
    };
    visit_all(visit_all, document_);
    const XmlElement* library = document_.child("library_geometries");
    if (library == nullptr) return;
    for (const auto& geometry : library->children)
      if (geometry->name == "geometry" && !seen_.contains(geometry.get()) &&
          !sources.contains('#' + geometry->get("id")))
        leave_out(name_of(*geometry), {}, "no node uses it", true);
  }

  const std::filesystem::path& file_;
  XmlElement document_;
  std::string unit_;
  std::map<std::pair<std::string, std::string>, const XmlElement*> by_id_;  // kind and id
  std::set<std::pair<std::string, std::string>> ambiguous_;
  std::map<const XmlElement*, DaeMesh> meshes_;
  std::set<const XmlElement*> open_, seen_;  // nodes on the path of below(); what the scene uses
  std::map<const XmlElement*, Below> below_;
  PartsOfFile out_;
  std::size_t visited_ = 0;
  std::uint64_t total_ = 0;
};

}  // namespace

PartsOfFile read_dae(const std::filesystem::path& file) { return DaeReader(file).read(); }

}  // namespace dismantle::mesh_files
