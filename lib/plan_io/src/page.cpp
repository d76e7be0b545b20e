// index.html: the viewer's template with a plan in it.
#include "dismantle/plan_io/page.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "dismantle/errors.h"
#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/plan_io/base64.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/shading.h"
#include "dismantle/plan_io/summary.h"
#include "page_view.h"

namespace dismantle {
namespace {

using PageJson = nlohmann::ordered_json;
static_assert(std::endian::native == std::endian::little, "typed arrays are little-endian on all that run a browser");

/// Two bytes each if that is enough.
std::string base64_of_indices(const std::vector<std::uint32_t>& indices, bool wide) {
  return wide ? base64_of(indices) : base64_of(std::vector<std::uint16_t>(indices.begin(), indices.end()));
}

/// Edges where the shading breaks, each once, as pairs of corners: an edge that two triangles shade smoothly has the
/// same two corners in both.
std::vector<std::uint32_t> sharp_edges(const ShadedMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(mesh.indices.size());
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [lo, hi] = std::minmax(mesh.indices[t + c], mesh.indices[t + (c + 1) % 3]);
      edges.push_back({lo, hi});
    }
  std::ranges::sort(edges);
  std::map<std::array<float, 6>, std::array<std::uint32_t, 2>> sharp;  // both sides of an edge have the same positions
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if (end == i + 1) {
      const Eigen::Vector3f &p = mesh.positions[edges[i][0]], &q = mesh.positions[edges[i][1]];
      const std::array<float, 3> a{p.x(), p.y(), p.z()}, b{q.x(), q.y(), q.z()};
      const auto &lo = std::min(a, b), &hi = std::max(a, b);
      sharp.try_emplace({lo[0], lo[1], lo[2], hi[0], hi[1], hi[2]}, edges[i]);
    }
    i = end;
  }
  std::vector<std::uint32_t> out;
  for (const auto& [place, edge] : sharp) out.insert(out.end(), edge.begin(), edge.end());
  return out;
}

/// Surface of a part about `center` (input units).
PageJson shape_json(const Part& part, const Normalization& units, const Eigen::Vector3d& center) {
  Mesh local = *part.mesh;
  for (auto& v : local.vertices) v = units.to_input(v) - center;
  const ShadedMesh shaded = shade(local);
  std::vector<float> positions;
  std::vector<std::int16_t> normals;
  for (std::size_t i = 0; i < shaded.positions.size(); ++i)
    for (Eigen::Index k = 0; k < 3; ++k) {
      positions.push_back(shaded.positions[i][k]);
      normals.push_back(static_cast<std::int16_t>(std::lround(32767 * std::clamp(shaded.normals[i][k], -1.0f, 1.0f))));
    }
  const bool wide = shaded.positions.size() > 0xffff;
  return {{"wide", wide},
          {"positions", base64_of(positions)},
          {"normals", base64_of(normals)},
          {"triangles", base64_of_indices(shaded.indices, wide)},
          {"edges", base64_of_indices(sharp_edges(shaded), wide)}};
}

PageJson page_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// The shapes, and the shape and pose of each part of the plan.
PageJson geometry_json(const Plan& plan, const Assembly& assembly) {
  std::map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) index_of.emplace(assembly.parts[i].name, i);
  const Normalization& units = assembly.normalization;
  const std::vector<geometry::ShapePlacement> placements = geometry::find_congruent(assembly.parts);
  std::map<std::size_t, std::size_t> shape_of;  // by original part
  PageJson shapes = PageJson::array(), parts = PageJson::array();
  for (const PlanPart& named : plan.assembly.parts) {
    const auto it = index_of.find(named.name);
    if (it == index_of.end()) throw InputError(named.name, "the plan has a part that the assembly lacks");
    const geometry::ShapePlacement& placement = placements[it->second];
    const Part& original = assembly.parts[placement.original];
    const Eigen::Vector3d center = units.to_input(original.mesh->box().center());
    const auto [shape, fresh] = shape_of.try_emplace(placement.original, shapes.size());
    if (fresh) shapes.push_back(shape_json(original, units, center));
    const Pose pose = units.pose_to_input(placement.pose);
    const Eigen::Vector3d at = pose * center;
    const Aabb box = assembly.parts[it->second].mesh->box();
    parts.push_back({{"shape", shape->second},
                     {"place", {at.x(), at.y(), at.z(), pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z()}},
                     {"box", {page_point(units.to_input(box.lo)), page_point(units.to_input(box.hi))}}});
  }
  return {{"parts", std::move(parts)}, {"shapes", std::move(shapes)}};
}

/// JSON without blanks between its values, safe in a script element whatever names it has: `<` occurs in strings only.
std::string for_script(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  bool in_string = false, escaped = false;
  for (const char c : json) {
    if (!in_string && (c == ' ' || c == '\n')) continue;
    if (c == '"' && !escaped) in_string = !in_string;
    escaped = c == '\\' && !escaped;
    c == '<' ? out += "\\u003c" : out += c;
  }
  return out;
}

}  // namespace

std::string to_page(const Plan& plan, const Assembly& assembly, const std::string& page_template,
                    const ExplainSettings& settings) {
  const std::string_view mark = "@DISMANTLE_DATA@";
  const std::size_t place = page_template.find(mark);
  if (place == std::string::npos || page_template.find(mark, place + 1) != std::string::npos)
    throw Error("the viewer's template does not have exactly one place for the data");
  const DrawnPlan drawn(plan);
  std::string data = "{\"format\":\"dismantle.page\",\"version\":2,\"plan\":" + to_json(drawn.plan);
  const auto add = [&](const char* key, const PageJson& value) {
    data += key + value.dump(-1, ' ', false, PageJson::error_handler_t::replace);
  };
  add(",\"result\":", {{"word", result_word(plan)}, {"text", result_text(plan)}});
  const PageJson geometry = geometry_json(plan, assembly);
  PartShapes shapes;
  for (const PageJson& part : geometry["parts"]) shapes.push_back(part["shape"].get<std::size_t>());
  add(",\"geometry\":", geometry);
  add(",\"view\":", page_view(plan, drawn, assembly, shapes, settings));
  data += "}";
  return page_template.substr(0, place) + for_script(data) + page_template.substr(place + mark.size());
}

}  // namespace dismantle
