// 3MF: the core specification, and objects in other model files of the archive (production extension).
#include "three_mf.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/geometry/length_unit.h"
#include "input_limits.h"
#include "model_3mf.h"

namespace dismantle::mesh_files {
namespace {

class Builder {
 public:
  explicit Builder(const std::filesystem::path& file) : file_(file), archive_(file, "3mf file") {}

  PartsOfFile build() {
    const std::string root = target_3mf(archive_, file_, "_rels/.rels", "/3dmodel");
    root_ = root.empty() ? "3D/3dmodel.model" : root;
    unit_ = model(root_).unit;
    if (model(root_).items.empty()) fail("its build has no items: nothing is placed");
    for (const Placed3mf& item : model(root_).items) place(item, root_, Eigen::Affine3d::Identity(), {}, "");
    for (const std::string& id : model(root_).order)
      if (!placed_.contains({root_, id}))
        leave_out(named(model(root_).objects.at(id), id), {}, "the file has it in no build item", true);
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const { throw InputError(file_.string(), problem); }

  const Model3mf& model(const std::string& name) {
    const auto known = models_.find(name);
    return known != models_.end() ? known->second
                                  : models_.emplace(name, read_model_3mf(archive_, file_, name)).first->second;
  }

  static std::string named(const Object3mf& object, const std::string& id) {
    return object.name.empty() ? "Object_" + id : object.name;
  }

  void leave_out(std::string name, const std::vector<std::string>& parents, std::string problem, bool by_meaning) {
    RawPart part;
    part.name = std::move(name);
    part.file = file_.filename().string();
    part.parents = parents;
    part.unit = unit_;
    part.problem = std::move(problem);
    part.by_meaning = by_meaning;
    out_.parts.push_back(std::move(part));
  }

  /// `above`: name of the object that has `placed` as its only component: the name of the part, if it has none itself.
  void place(const Placed3mf& placed, const std::string& from, const Eigen::Affine3d& outer,
             const std::vector<std::string>& parents, const std::string& above) {
    if (++visited_ > reader_process::kInputLimits.instances)
      fail(fmt::format("more than {} objects", reader_process::kInputLimits.instances));
    if (++depth_ > reader_process::kInputLimits.nesting) fail("components are nested too deep, or contain themselves");
    const std::string& path = placed.path.empty() ? from : placed.path;
    if (path != from && !archive_.holds(path)) {
      leave_out(above.empty() ? "Object_" + placed.object : above, parents,
                fmt::format("the archive lacks '{}', which holds it", path), false);
    } else {
      const Model3mf& here = model(path);
      const auto found = here.objects.find(placed.object);
      if (found == here.objects.end()) fail(fmt::format("{}: there is no object {}", path, placed.object));
      placed_.insert({path, placed.object});
      // A place is in the unit of the file that states it.
      Eigen::Affine3d inner = placed.place;
      inner.translation() *= scale(from);
      visit(found->second, placed.object, path, outer * inner, parents, above);
    }
    --depth_;
  }

  double scale(const std::string& path) { return metres_in(model(path).unit) / metres_in(unit_); }

  void visit(const Object3mf& object, const std::string& id, const std::string& path, const Eigen::Affine3d& place_of,
             std::vector<std::string> parents, const std::string& above) {
    if (!above.empty() && !object.name.empty() && object.name != above) parents.push_back(above);
    const std::string name = object.name.empty() && !above.empty() ? above : named(object, id);
    if (object.type == "support" || object.type == "solidsupport")
      return leave_out(name, parents, "the file calls it a support", true);
    if (object.type == "other") return leave_out(name, parents, "the file says that it is not to be built", true);
    if (!object.mesh.vertices.empty() || object.components.empty()) add(object, name, path, place_of, parents);
    const bool wraps = object.components.size() == 1;
    if (!wraps) parents.push_back(name);
    for (const Placed3mf& component : object.components)
      place(component, path, place_of, parents, !wraps ? "" : object.name.empty() ? above : object.name);
  }

  void add(const Object3mf& object, const std::string& name, const std::string& path, const Eigen::Affine3d& place_of,
           const std::vector<std::string>& parents) {
    if (object.beams && object.mesh.triangles.empty())
      return leave_out(name, parents, "it is a lattice of beams, which are not read", false);
    if (object.mesh.triangles.empty()) return leave_out(name, parents, "it has no triangles", false);
    if (object.beams) out_.warnings.push_back(fmt::format("'{}' has a lattice of beams, which are not read", name));
    total_ += object.mesh.triangles.size();
    if (total_ > reader_process::kInputLimits.triangles)
      fail(fmt::format("more than {} triangles", reader_process::kInputLimits.triangles));
    RawPart part;
    part.name = name;
    part.file = file_.filename().string();
    part.parents = parents;
    part.unit = unit_;
    part.colour = object.colour.get();
    part.mesh = object.mesh;
    const double own = scale(path);
    for (auto& v : part.mesh.vertices) v = place_of * (own * v);
    if (place_of.linear().determinant() < 0)
      for (auto& t : part.mesh.triangles) std::swap(t[1], t[2]);
    out_.parts.push_back(std::move(part));
  }

  const std::filesystem::path& file_;
  reader_process::ZipArchive archive_;
  std::string root_, unit_;
  std::map<std::string, Model3mf> models_;
  std::set<std::pair<std::string, std::string>> placed_;  // file and id of objects
  PartsOfFile out_;
  std::size_t visited_ = 0, depth_ = 0, total_ = 0;
};

}  // namespace

PartsOfFile read_3mf(const std::filesystem::path& file) { return Builder(file).build(); }

}  // namespace dismantle::mesh_files
