// plan.glb: glTF 2.0, binary.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "dismantle/errors.h"
#include "dismantle/plan_io/animation.h"
#include "json/hex_colour.h"
#include "shading.h"
#include "timeline.h"

namespace dismantle {
namespace {

using Json = nlohmann::ordered_json;
static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr double kCreaseAngle = 30.0 * std::numbers::pi / 180.0;
enum ComponentType { kUint16 = 5123, kUint32 = 5125, kFloat = 5126 };
enum Target { kNone = 0, kVertices = 34962, kIndices = 34963 };

/// Collects the buffer, its views and accessors.
class Buffer {
 public:
  /// `count` elements of type `type` from `data`. Returns the accessor's index.
  template <class Scalar>
  std::size_t add(const std::vector<Scalar>& data, ComponentType component, const char* type, std::size_t count,
                  Target target, bool bounds) {
    bytes_.resize((bytes_.size() + 3) & ~std::size_t{3});
    const std::size_t offset = bytes_.size(), length = data.size() * sizeof(Scalar);
    bytes_.resize(offset + length);
    std::memcpy(bytes_.data() + offset, data.data(), length);
    Json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}};
    if (target != kNone) view["target"] = static_cast<int>(target);
    Json accessor = {{"bufferView", views_.size()},
                     {"componentType", static_cast<int>(component)},
                     {"count", count},
                     {"type", type}};
    if (bounds) {
      const std::size_t width = data.size() / count;
      std::vector<Scalar> lo(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(width)), hi = lo;
      for (std::size_t i = 0; i < data.size(); ++i) {
        lo[i % width] = std::min(lo[i % width], data[i]);
        hi[i % width] = std::max(hi[i % width], data[i]);
      }
      accessor["min"] = lo;
      accessor["max"] = hi;
    }
    views_.push_back(std::move(view));
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
  }

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  const Json& views() const { return views_; }
  const Json& accessors() const { return accessors_; }

 private:
  std::vector<std::uint8_t> bytes_;
  Json views_ = Json::array(), accessors_ = Json::array();
};

/// sRGB component to the linear one that glTF wants.
double linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

/// Colour of the part that leaves as number `rank` of `count`: along the rainbow from red to violet, light and
/// dark by turns so that neighbours differ.
Json colour_of(std::size_t rank, std::size_t count) {
  const double hue = 0.8 * 6.0 * (count > 1 ? double(rank) / double(count - 1) : 0.0);  // sixths of a turn
  const double value = rank % 2 == 0 ? 0.95 : 0.7, saturation = 0.7;
  Json rgb = Json::array();
  for (const double shift : {5.0, 3.0, 1.0}) {
    const double k = std::fmod(shift + hue, 6.0);
    rgb.push_back(static_cast<float>(linear(value * (1 - saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0)))));
  }
  rgb.push_back(1);
  return rgb;
}

/// Parts by the order in which they leave; those that stay follow with rank `leavers`.
std::vector<std::size_t> ranks_of(const Plan& plan, const Assembly& assembly, std::size_t& leavers) {
  std::map<std::string, std::size_t> rank;
  leavers = 0;
  for (const PlanStep& step : plan.disassembly)
    for (const auto& group : step.separates)
      for (const std::string& name : group)
        if (rank.emplace(name, leavers).second) ++leavers;
  std::vector<std::size_t> out;
  for (const Part& part : assembly.parts) {
    const auto it = rank.find(part.name);
    out.push_back(it == rank.end() ? leavers : it->second);
  }
  return out;
}

Json material(const std::string& name, Json colour) {
  return {{"name", name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", std::move(colour)}, {"metallicFactor", 0.1}, {"roughnessFactor", 0.6}}}};
}

/// A part's own colour; light grey for one that has none.
Json own_colour(const std::optional<Rgba>& colour) {
  const Rgba c = colour.value_or(Rgba{200, 200, 200});
  Json out = Json::array();
  for (const std::uint8_t channel : {c.r, c.g, c.b}) out.push_back(static_cast<float>(linear(channel / 255.0)));
  out.push_back(static_cast<float>(c.a / 255.0));
  return out;
}

/// Whether parts are shown in their own colours: most have one, and these tell parts apart. A CAD program that gives
/// every part the same grey has given none.
bool has_own_colours(const Assembly& assembly) {
  std::set<std::string> different;
  std::size_t coloured = 0;
  for (const Part& part : assembly.parts) {
    if (!part.colour) continue;
    ++coloured;
    different.insert(to_hex(*part.colour));
  }
  return 2 * coloured > assembly.parts.size() && different.size() > 1;
}

/// In the colour of the part, with that of the order in `extras.order_color` (linear RGBA) for viewers that can switch;
/// or in that of the order alone.
Json material_of(const Part& part, bool own_colours, Json order_colour) {
  if (!own_colours) return material(part.name, std::move(order_colour));
  Json out = material(part.name, own_colour(part.colour));
  if (part.colour && part.colour->a < 255) out["alphaMode"] = "BLEND";
  out["extras"] = {{"order_color", std::move(order_colour)}};
  return out;
}

template <class Scalar, class Vector>
std::vector<Scalar> flat(const std::vector<Vector>& vectors) {
  std::vector<Scalar> out;
  out.reserve(3 * vectors.size());
  for (const Vector& v : vectors) out.insert(out.end(), {v.x(), v.y(), v.z()});
  return out;
}

/// Returns the primitive; null for a mesh without a visible triangle.
Json primitive(const Part& part, const Normalization& units, const Eigen::Vector3d& center, std::size_t material_index,
               Buffer& buffer) {
  Mesh local = *part.mesh;
  for (auto& v : local.vertices) v = units.to_input(v) - center;
  const ShadedMesh shaded = shade(local, kCreaseAngle);
  if (shaded.indices.empty()) return nullptr;
  const std::size_t n = shaded.positions.size();
  Json attributes;
  attributes["POSITION"] = buffer.add(flat<float>(shaded.positions), kFloat, "VEC3", n, kVertices, true);
  attributes["NORMAL"] = buffer.add(flat<float>(shaded.normals), kFloat, "VEC3", n, kVertices, false);
  std::size_t indices = 0;
  if (n < 0xffff)
    indices = buffer.add(std::vector<std::uint16_t>(shaded.indices.begin(), shaded.indices.end()), kUint16, "SCALAR",
                         shaded.indices.size(), kIndices, false);
  else
    indices = buffer.add(shaded.indices, kUint32, "SCALAR", shaded.indices.size(), kIndices, false);
  return {{"attributes", std::move(attributes)}, {"indices", indices}, {"material", material_index}};
}

/// When each step of an animation happens, for viewers that show steps.
Json step_times(const Timeline& line, const Assembly& assembly) {
  Json steps = Json::array();
  for (const StepTime& s : line.steps) {
    Json parts = Json::array();
    for (const PartId id : s.parts) parts.push_back(assembly.parts[id].name);
    steps.push_back({{"step", s.step}, {"begin", s.begin}, {"end", s.end}, {"parts", std::move(parts)}});
  }
  return steps;
}

/// Channels that move `node` along `track`. Node translations are relative to `origin`.
void animate(const Track& track, std::size_t node, const Eigen::Vector3d& center, const Eigen::Vector3d& origin,
             Buffer& buffer, std::map<std::vector<float>, std::size_t>& clocks, Json& samplers, Json& channels) {
  std::vector<float> times, translations, rotations;
  bool turns = false;
  for (const Key& key : track.keys) {
    times.push_back(key.time);
    const Eigen::Vector3f t = (key.pose * center - origin).cast<float>();
    const Eigen::Quaternionf q = key.pose.q.cast<float>().normalized();
    translations.insert(translations.end(), {t.x(), t.y(), t.z()});
    rotations.insert(rotations.end(), {q.x(), q.y(), q.z(), q.w()});
    turns = turns || !key.pose.q.vec().isZero(0);
  }
  const std::size_t n = times.size();
  const auto [clock, fresh] = clocks.try_emplace(times, 0);
  if (fresh) clock->second = buffer.add(times, kFloat, "SCALAR", n, kNone, true);
  const auto channel = [&](const char* path, std::size_t output) {
    channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers.push_back({{"input", clock->second}, {"interpolation", "LINEAR"}, {"output", output}});
  };
  channel("translation", buffer.add(translations, kFloat, "VEC3", n, kNone, false));
  if (turns) channel("rotation", buffer.add(rotations, kFloat, "VEC4", n, kNone, false));
}

void append_u32(std::vector<std::uint8_t>& out, std::size_t value) {
  if (value > std::numeric_limits<std::uint32_t>::max())
    throw Error("the animation would be larger than the 4 GB that a .glb file can hold");
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::vector<std::uint8_t> pack(const Json& json, std::vector<std::uint8_t> binary) {
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) & ~std::size_t{3}, ' ');
  binary.resize((binary.size() + 3) & ~std::size_t{3}, 0);
  std::vector<std::uint8_t> out;
  out.reserve(28 + text.size() + binary.size());
  append_u32(out, 0x46546C67);  // "glTF"
  append_u32(out, 2);
  append_u32(out, 12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size()));
  append_u32(out, text.size());
  append_u32(out, 0x4E4F534A);  // "JSON"
  out.insert(out.end(), text.begin(), text.end());
  if (!binary.empty()) {
    append_u32(out, binary.size());
    append_u32(out, 0x004E4942);  // "BIN"
    out.insert(out.end(), binary.begin(), binary.end());
  }
  return out;
}

}  // namespace

std::vector<std::uint8_t> to_glb(const Plan& plan, const Assembly& assembly) {
  Buffer buffer;
  Json nodes = Json::array(), meshes = Json::array(), materials = Json::array();

  // Single precision counts from the middle of the assembly: input far from its origin keeps its digits, since
  // the root's translation is applied in the viewer's own precision.
  const Eigen::Vector3d origin = assembly.input_box.empty() ? Eigen::Vector3d(0, 0, 0) : assembly.input_box.center();
  Json root = {{"name", "assembly"}};
  root["translation"] = {origin.x(), origin.y(), origin.z()};
  root["children"] = Json::array();
  nodes.push_back(nullptr);

  std::size_t leavers = 0;
  const std::vector<std::size_t> ranks = ranks_of(plan, assembly, leavers);
  const bool own_colours = has_own_colours(assembly);
  std::vector<Eigen::Vector3d> centers;
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
    const Part& part = assembly.parts[i];
    const Aabb box = part.mesh->box();
    centers.push_back(box.empty() ? origin : assembly.normalization.to_input(box.center()));
    const Eigen::Vector3f at = (centers[i] - origin).cast<float>();
    Json node = {{"name", part.name}, {"translation", {at.x(), at.y(), at.z()}}};
    if (Json shape = primitive(part, assembly.normalization, centers[i], materials.size(), buffer); !shape.is_null()) {
      node["mesh"] = meshes.size();
      meshes.push_back({{"name", part.name}, {"primitives", Json::array({std::move(shape)})}});
      materials.push_back(material_of(
          part, own_colours, ranks[i] == leavers ? Json::array({0.4, 0.4, 0.4, 1}) : colour_of(ranks[i], leavers)));
    }
    root["children"].push_back(nodes.size());
    nodes.push_back(std::move(node));
  }
  if (root["children"].empty()) root.erase("children");
  nodes[0] = std::move(root);

  std::map<std::vector<float>, std::size_t> clocks;
  Json animations = Json::array();
  const auto add_animation = [&](const char* name, const std::vector<PlanStep>& steps) {
    Json samplers = Json::array(), channels = Json::array();
    const Timeline line = timeline(steps, assembly);
    for (const Track& track : line.tracks)
      animate(track, 1 + track.part, centers[track.part], origin, buffer, clocks, samplers, channels);
    if (channels.empty()) return;
    animations.push_back({{"name", name},
                          {"channels", std::move(channels)},
                          {"samplers", std::move(samplers)},
                          {"extras", {{"kind", name}, {"steps", step_times(line, assembly)}}}});
  };
  add_animation("disassembly", plan.disassembly);
  add_animation("assembly", plan.assembly_steps);

  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", plan.generator_name + " " + plan.generator_version}};
  json["scene"] = 0;
  json["scenes"] = Json::array({{{"name", "disassembly"}, {"nodes", {0}}}});
  json["nodes"] = std::move(nodes);
  if (!meshes.empty()) {
    json["meshes"] = std::move(meshes);
    json["materials"] = std::move(materials);
  }
  if (!animations.empty()) json["animations"] = std::move(animations);
  if (!buffer.bytes().empty()) {
    json["accessors"] = buffer.accessors();
    json["bufferViews"] = buffer.views();
    json["buffers"] = Json::array({{{"byteLength", buffer.bytes().size()}}});
  }
  return pack(json, buffer.bytes());
}

}  // namespace dismantle
