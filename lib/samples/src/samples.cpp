#include "dismantle/samples/samples.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "build.h"
#include "dismantle/run_context.h"

namespace dismantle::samples {
namespace {

ParamSpec rotate_seed_spec() {
  ParamSpec spec;
  spec.name = "rotate_seed";
  spec.type = ParamType::integer;
  spec.unit = std::string("1");
  spec.fallback = std::int64_t{0};
  spec.min = 0;
  spec.doc = "Seed of a random rotation of the whole assembly; 0 = no rotation.";
  return spec;
}

const std::vector<Maker>& makers() {
  static const std::vector<Maker> all = [] {
    std::vector<Maker> list;
    for (auto& group : {fit_makers(), slot_makers(), turning_makers(), leg_makers(), interlock_makers(),
                        machine_makers(), pressed_makers(), flexible_makers(), doubled_makers(), pile_makers()})
      list.insert(list.end(), group.begin(), group.end());
    for (Maker& m : list) m.sample.params.push_back(rotate_seed_spec());
    return list;
  }();
  return all;
}

/// Uniform over all rotations (Shoemake).
Eigen::Quaterniond random_rotation(std::uint64_t seed) {
  Rng rng(seed);
  const double u = rng.uniform(), v = rng.uniform(0, 2 * std::numbers::pi), w = rng.uniform(0, 2 * std::numbers::pi);
  return Eigen::Quaterniond(std::sqrt(1 - u) * std::sin(v), std::sqrt(1 - u) * std::cos(v), std::sqrt(u) * std::sin(w),
                            std::sqrt(u) * std::cos(w))
      .normalized();
}

void rotate(Model& model, const Eigen::Quaterniond& q) {
  for (RawPart& part : model.parts)
    for (Point& p : part.mesh.vertices) p = q * p;
  for (TruthStep& step : model.truth.steps)
    for (TruthMotion& motion : step.motions) {
      motion.screw.axis = q * motion.screw.axis;
      motion.screw.point = q * motion.screw.point;
    }
  for (TruthContact& contact : model.truth.contacts) {
    if (!contact.apart) continue;
    contact.apart->axis = q * contact.apart->axis;
    contact.apart->point = q * contact.apart->point;
  }
}

}  // namespace

Pose Screw::at(double u) const {
  Pose pose;
  pose.q = Eigen::Quaterniond(Eigen::AngleAxisd(u * angle, axis));
  pose.t = point - pose.q * point + u * advance * axis;
  return pose;
}

const std::vector<Sample>& list() {
  static const std::vector<Sample> all = [] {
    std::vector<Sample> samples;
    for (const Maker& m : makers()) samples.push_back(m.sample);
    return samples;
  }();
  return all;
}

const Sample* find(const std::string& name) {
  for (const Sample& s : list())
    if (s.name == name) return &s;
  return nullptr;
}

Model make_model(const std::string& name, const ParamSet& given) {
  for (const Maker& m : makers()) {
    if (m.sample.name != name) continue;
    const ParamSet values = complete(m.sample.params, given);
    Model model = m.make(values);
    const auto seed = std::get<std::int64_t>(values.at("rotate_seed"));
    if (seed != 0) rotate(model, random_rotation(static_cast<std::uint64_t>(seed)));
    return model;
  }
  throw std::invalid_argument("no sample is called '" + name + "'");
}

std::vector<RawPart> make(const std::string& name, const ParamSet& given) { return make_model(name, given).parts; }

std::string add_part(Model& model, std::string name, Mesh mesh) {
  require_solid(mesh, name);
  model.parts.push_back({name, name + ".obj", std::move(mesh)});
  return name;
}

Screw along(const Point& travel) { return {travel.normalized(), Point::Zero(), 0.0, travel.norm()}; }

TruthStep slide(const std::string& part, const Point& displacement, bool out) {
  TruthStep step;
  step.motions.push_back({part, along(displacement)});
  if (out) step.out = part;
  return step;
}

}  // namespace dismantle::samples
