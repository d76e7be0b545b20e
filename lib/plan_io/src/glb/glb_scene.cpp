#include "glb/glb_scene.h"

#include <map>
#include <utility>

#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/shading.h"
#include "glb/glb_colours.h"

namespace dismantle {
namespace {

template <class Scalar, class Vector>
std::vector<Scalar> flat(const std::vector<Vector>& vectors) {
  std::vector<Scalar> out;
  out.reserve(3 * vectors.size());
  for (const Vector& v : vectors) out.insert(out.end(), {v.x(), v.y(), v.z()});
  return out;
}

/// The arrays of a part's surface about `center`, without a material; null for a mesh without a visible triangle.
GlbJson surface(const Part& part, const Normalization& units, const Eigen::Vector3d& center, GlbBuffer& buffer) {
  Mesh local = *part.mesh;
  for (auto& v : local.vertices) v = units.to_input(v) - center;
  const ShadedMesh shaded = shade(local);
  if (shaded.indices.empty()) return nullptr;
  const std::size_t n = shaded.positions.size();
  GlbJson attributes;
  attributes["POSITION"] = buffer.add(flat<float>(shaded.positions), kFloat, "VEC3", n, kVertices, true);
  attributes["NORMAL"] = buffer.add(flat<float>(shaded.normals), kFloat, "VEC3", n, kVertices, false);
  std::size_t indices = 0;
  if (n < 0xffff)
    indices = buffer.add(std::vector<std::uint16_t>(shaded.indices.begin(), shaded.indices.end()), kUint16, "SCALAR",
                         shaded.indices.size(), kIndices, false);
  else
    indices = buffer.add(shaded.indices, kUint32, "SCALAR", shaded.indices.size(), kIndices, false);
  return {{"attributes", std::move(attributes)}, {"indices", indices}};
}

GlbJson array_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
GlbJson array_of(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

}  // namespace

GlbScene::GlbScene(const Plan& plan, const Assembly& assembly, const InputFrame& frame) {
  // Single-precision data is relative to the assembly's centre, so that input far from its origin keeps its digits: the
  // viewer applies the root's translation in its own precision.
  origin_ = assembly.input_box.empty() ? Eigen::Vector3d(0, 0, 0) : assembly.input_box.center();
  GlbJson root = {{"name", "assembly"}};
  root["translation"] = array_of(Eigen::Vector3d(frame.metres * (frame.to_y_up() * origin_)));
  const Eigen::Quaterniond turn = frame.to_y_up();
  if (!turn.vec().isZero(0)) root["rotation"] = array_of(turn);
  root["scale"] = {frame.metres, frame.metres, frame.metres};
  const std::string up = axis_text(frame.up);
  root["extras"] = {
      {"input_unit", frame.unit}, {"unit_known", frame.unit_known}, {"input_up", up[0] == '+' ? up.substr(1) : up}};
  nodes_.push_back(nullptr);

  const std::vector<GlbPaint> paints = paint_parts(plan, assembly);
  const std::vector<geometry::ShapePlacement> placements = geometry::find_congruent(assembly.parts);
  std::map<std::size_t, GlbJson> surface_of;                           // by original part
  std::map<std::string, std::size_t> material_of;                      // by its text
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> mesh_of;  // by original part and material
  GlbJson children = GlbJson::array();
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
    const Part& part = assembly.parts[i];
    const std::size_t original = placements[i].original;
    const Part& drawn = assembly.parts[original];
    const Aabb box = drawn.mesh->box();
    bodies_.push_back({assembly.normalization.pose_to_input(placements[i].pose),
                       box.empty() ? origin_ : assembly.normalization.to_input(box.center())});
    children.push_back(nodes_.size());
    nodes_.push_back({{"name", part.name}});
    place(i, Pose{});
    const auto [shape, fresh] = surface_of.try_emplace(original);
    if (fresh) shape->second = surface(drawn, assembly.normalization, bodies_[i].center, buffer_);
    if (shape->second.is_null()) continue;
    const auto [material, unknown] = material_of.try_emplace(
        paints[i].material.dump(-1, ' ', false, GlbJson::error_handler_t::replace), materials_.size());
    if (unknown) materials_.push_back(paints[i].material);
    const auto [mesh, first] = mesh_of.try_emplace({original, material->second}, meshes_.size());
    if (first) {
      GlbJson primitive = shape->second;
      primitive["material"] = material->second;
      meshes_.push_back({{"name", part.name}, {"primitives", GlbJson::array({std::move(primitive)})}});
    }
    nodes_.back()["mesh"] = mesh->second;
    if (!paints[i].order_colour.is_null()) nodes_.back()["extras"] = {{"order_color", paints[i].order_colour}};
  }
  if (!children.empty()) root["children"] = std::move(children);
  nodes_[0] = std::move(root);
}

Pose GlbScene::node_pose(std::size_t part, const Pose& displacement) const {
  const Body& body = bodies_[part];
  return {displacement * (body.shape * body.center) - origin_, (displacement.q * body.shape.q).normalized()};
}

void GlbScene::place(std::size_t part, const Pose& displacement) {
  const Pose pose = node_pose(part, displacement);
  const Eigen::Vector3f t = pose.t.cast<float>();
  GlbJson& node = nodes_[node_of(part)];
  node["translation"] = {t.x(), t.y(), t.z()};
  if (!pose.q.vec().isZero(0)) node["rotation"] = array_of(pose.q);
}

std::vector<std::uint8_t> GlbScene::file(const Plan& plan, const char* scene_name, GlbJson animations) const {
  GlbJson json;
  json["asset"] = {{"version", "2.0"}, {"generator", plan.generator_name + " " + plan.generator_version}};
  json["scene"] = 0;
  json["scenes"] = GlbJson::array({{{"name", scene_name}, {"nodes", {0}}}});
  json["nodes"] = nodes_;
  if (!meshes_.empty()) {
    json["meshes"] = meshes_;
    json["materials"] = materials_;
  }
  if (!animations.empty()) json["animations"] = std::move(animations);
  if (!buffer_.bytes().empty()) {
    json["accessors"] = buffer_.accessors();
    json["bufferViews"] = buffer_.views();
    json["buffers"] = GlbJson::array({{{"byteLength", buffer_.bytes().size()}}});
  }
  return pack_glb(json, buffer_.bytes());
}

}  // namespace dismantle
