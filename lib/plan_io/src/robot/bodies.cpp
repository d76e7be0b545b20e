#include "robot/bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "dismantle/errors.h"
#include "dismantle/geometry/mass_properties.h"
#include "dismantle/geometry/mesh_measure.h"
#include "json/json_text.h"

namespace dismantle {
namespace {

constexpr double kUsualDensity = 1;       // g/cm3, as `dismantle stability` has it
constexpr double kShellThickness = 0.01;  // of the diagonal

const Part& part_named(const std::string& name, const Assembly& assembly) {
  const auto it = std::ranges::find(assembly.parts, name, &Part::name);
  if (it == assembly.parts.end())
    throw InputError(assembly.source, fmt::format("the plan has a part '{}', which the assembly does not have", name));
  return *it;
}

/// Names that programs for robots take: no spaces, no '/', ASCII.
std::string link_name(const std::string& part, std::set<std::string>& taken) {
  std::string name;
  bool readable = false;
  for (const char c : part.substr(0, 60)) {
    const bool alphanumeric = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    readable = readable || alphanumeric;
    name += alphanumeric || c == '-' || c == '.' || c == '_' ? c : '_';
  }
  if (!readable) name = "part";
  if (name.front() == '.' || name.front() == '-') name.front() = '_';
  std::string unique = name;
  for (unsigned n = 2; !taken.insert(unique).second; ++n) unique = fmt::format("{}_{}", name, n);
  return unique;
}

Mesh in_metres(const Mesh& mesh, const Normalization& normalization, const RobotFrame& frame) {
  Mesh out = mesh;
  for (Eigen::Vector3d& v : out.vertices) v = frame.point(normalization.to_input(v));
  return out;
}

void weigh(const Mesh& mesh, double density, RobotBody& body) {
  const MassProperties solid = mass_properties(mesh);
  if (!body.open && solid.volume > 0) {
    body.mass = density * solid.volume;
    body.center = solid.center;
    body.inertia = density * solid.inertia;
    return;
  }
  const Aabb box = mesh.box();
  const double thickness = kShellThickness * box.size().norm();
  const Eigen::Vector3d square = box.size().cwiseMax(thickness).cwiseAbs2();
  body.mass = density * surface_area(mesh) * thickness;
  body.center = box.center();
  body.inertia = Eigen::Vector3d(square.sum() * Eigen::Vector3d::Ones() - square).asDiagonal();
  body.inertia *= body.mass / 12;
}

std::string obj_of(const Mesh& mesh, const std::string& name) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "o {}\n", name);
  for (const Eigen::Vector3d& v : mesh.vertices) fmt::format_to(out, "v {}\n", numbers_text(v));
  for (const Triangle& t : mesh.triangles) fmt::format_to(out, "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

}  // namespace

std::vector<RobotBody> robot_bodies(const Plan& plan, const Assembly& assembly, const RobotFrame& frame) {
  std::set<std::string> taken = {"world", "assembly"};  // roots of the models
  std::vector<RobotBody> bodies;
  for (const PlanPart& named : plan.assembly.parts) {
    const Part& part = part_named(named.name, assembly);
    RobotBody& body = bodies.emplace_back();
    body.part = named.name;
    body.link = link_name(named.name, taken);
    body.mesh = body.link + ".obj";
    body.open = part.open;
    body.colour = named.colour;
    const double density = 1000 * part.density.value_or(kUsualDensity);
    weigh(in_metres(*part.mesh, assembly.normalization, frame), density, body);
  }
  return bodies;
}

std::vector<ExportedFile> mesh_files(const std::vector<RobotBody>& bodies, const Assembly& assembly,
                                     const RobotFrame& frame) {
  std::vector<ExportedFile> files;
  for (const RobotBody& body : bodies) {
    const Mesh mesh = in_metres(*part_named(body.part, assembly).mesh, assembly.normalization, frame);
    files.push_back({"meshes/" + body.mesh, obj_of(mesh, body.link)});
  }
  return files;
}

std::string numbers_text(const Eigen::VectorXd& numbers) {
  std::string out;
  for (const double x : numbers) out += (out.empty() ? "" : " ") + number_text(x);
  return out;
}

std::string rgba_text(const Rgba& colour) {
  const auto share = [](std::uint8_t value) { return value / 255.0; };
  return fmt::format("{:.3g} {:.3g} {:.3g} {:.3g}", share(colour.r), share(colour.g), share(colour.b), share(colour.a));
}

}  // namespace dismantle
