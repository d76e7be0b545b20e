// acme.stepper: a simulator. No inertia; a body takes small steps along the force until its surface points touch.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/plugin.h"
#include "dismantle/plugin/finite.h"

namespace {

using Eigen::Vector3d;

struct AcmeStepperParameters {
  double speed = 1.0;
  double time_step = 0.01;
  double share = 0.5;

  static void describe(dismantle::Schema<AcmeStepperParameters>& s) {
    s.add("speed", &AcmeStepperParameters::speed,
          {.unit = "assembly units / s", .min = 0, .min_open = true, .doc = "Speed of a body that is pushed."});
    s.add("time_step", &AcmeStepperParameters::time_step,
          {.unit = "s", .min = 0, .min_open = true, .doc = "Length of a step."});
    s.add(
        "share", &AcmeStepperParameters::share,
        {.unit = "1",
         .min = 0,
         .max = 1,
         .doc = "Share of the verifier's tolerance at which a body counts as stopped; the rest is in reserve for what "
                "lies between the sampled points."});
  }
};

constexpr dismantle::Capabilities kProvides{.dynamics = true, .contacts = true, .distance = true, .max_moving = 1};

/// Once per assembly, shared by all worlds: a hierarchy of triangles per part.
struct Trees final : dismantle::PreparedAssembly {
  std::vector<dismantle::TriangleBvh> parts;
  double tolerance = 0;  // of the verifier, assembly units
};

class AcmeStepperWorld final : public dismantle::World {
 public:
  AcmeStepperWorld(const dismantle::Assembly& assembly, const Trees& trees, dismantle::Scene scene,
                   dismantle::MotionSpace space, const AcmeStepperParameters& params)
      : assembly_(assembly), trees_(trees), scene_(std::move(scene)), space_(space), params_(params) {
    if (scene_.moving.size() != 1) throw std::invalid_argument("acme.stepper moves exactly one part at a time");
    const auto box = surface().box();
    center_ = box.center();
    for (const auto& v : surface().vertices) radius_ = std::max(radius_, (v - center_).norm());
    for (const auto& fixed : scene_.fixed)
      for (const auto& v : assembly_.parts[fixed.part].mesh->vertices) fixed_points_.push_back(fixed.pose * v);
  }

  const dismantle::Scene& scene() const override { return scene_; }
  dismantle::MotionSpace space() const override { return space_; }
  dismantle::State initial_state() const override { return {{dismantle::BodyState{.pose = scene_.moving[0].pose}}}; }
  Vector3d center(std::size_t) const override { return center_; }
  double radius(std::size_t) const override { return radius_; }
  double torque_arm(std::size_t) const override { return radius_; }

  dismantle::StepReport advance(dismantle::State& state, const dismantle::Action& action, double duration,
                                dismantle::Trace* trace) override {
    dismantle::StepReport report;
    report.finite = dismantle::is_finite(state) && dismantle::is_finite(action);
    if (!report.finite) return report;
    dismantle::Pose& pose = state.bodies.at(0).pose;
    const dismantle::Pose begin = pose;
    const auto count = static_cast<std::uint64_t>(std::ceil(duration / params_.time_step - 1e-9));
    for (std::uint64_t n = 0; n < count && !report.stalled; ++n) {
      dismantle::State next = state;
      move(next.bodies[0].pose, action.wrenches.at(0));
      ++report.steps;
      report.stalled = penetration(next) > params_.share * trees_.tolerance;
      if (report.stalled) break;
      state = next;
      if (trace != nullptr) trace->push_back({pose});
    }
    report.travel = dismantle::screw_travel(begin, pose, center_, radius_);
    return report;
  }

  double penetration(const dismantle::State& state) override {
    if (!dismantle::is_finite(state)) return std::numeric_limits<double>::infinity();
    contacts(state, scratch_);
    double deepest = 0;
    for (const auto& contact : scratch_) deepest = std::max(deepest, contact.depth);
    return deepest;
  }

  void contacts(const dismantle::State& state, std::vector<dismantle::Contact>& out) override {
    out.clear();
    const dismantle::PartId part = scene_.moving[0].part;
    for (const auto& fixed : scene_.fixed) {
      const double allowed = assembly_.initial_overlap(part, fixed.part);
      const dismantle::Pose to_fixed = fixed.pose.inverse() * state.bodies.at(0).pose;
      const auto& tree = trees_.parts[fixed.part];
      for (const auto& v : surface().vertices) {
        const Vector3d local = to_fixed * v;
        const double depth = -tree.signed_distance(local) - allowed;
        if (depth <= 0) continue;
        const Vector3d outwards = tree.closest(local).point - local;
        const Vector3d normal = outwards.norm() > 0 ? Vector3d(outwards.normalized()) : Vector3d::UnitZ();
        out.push_back({part, fixed.part, fixed.pose * local, fixed.pose.q * normal, depth});
      }
    }
  }

  bool separated(const dismantle::State& state) override {
    if (!dismantle::is_finite(state)) return false;
    if (scene_.fixed.empty()) return true;
    std::vector<Vector3d> points;
    for (const auto& v : assembly_.parts[scene_.moving[0].part].mesh->vertices)
      points.push_back(state.bodies.at(0).pose * v);
    return dismantle::separate(points, fixed_points_).has_value();
  }

  void add_contact_sample(dismantle::PartId, dismantle::PartId, const Vector3d&) override {
  }  // its sample points are fixed

 private:
  const dismantle::Mesh& surface() const { return *assembly_.parts[scene_.moving[0].part].surface; }

  void move(dismantle::Pose& pose, const dismantle::Wrench& wrench) const {
    const double length = params_.speed * params_.time_step;
    if (wrench.force.norm() > 0) pose.t += length * wrench.force.normalized();
    if (space_ == dismantle::MotionSpace::translation || wrench.torque.norm() == 0) return;
    const Vector3d turn = length / std::max(radius_, 1e-9) * wrench.torque.normalized();
    const Eigen::Quaterniond q = dismantle::rotation_from_vector(turn);
    const Vector3d c = pose * center_;
    pose = dismantle::Pose{c - q * c, q} * pose;  // about the body's centre
  }

  const dismantle::Assembly& assembly_;
  const Trees& trees_;
  dismantle::Scene scene_;
  dismantle::MotionSpace space_;
  AcmeStepperParameters params_;
  Vector3d center_ = Vector3d::Zero();
  double radius_ = 0;
  std::vector<Vector3d> fixed_points_;
  std::vector<dismantle::Contact> scratch_;
};

class AcmeStepper final : public dismantle::Simulator {
 public:
  explicit AcmeStepper(const AcmeStepperParameters& params) : params_(params) {}

  dismantle::Capabilities capabilities() const noexcept override { return kProvides; }

  std::shared_ptr<const dismantle::PreparedAssembly> prepare(const dismantle::Assembly& assembly, double tolerance,
                                                             dismantle::RunContext& context) override {
    auto trees = std::make_shared<Trees>();
    trees->tolerance = tolerance;
    for (const auto& part : assembly.parts) {
      context.progress("trees", trees->parts.size(), assembly.parts.size(), part.name);
      trees->parts.emplace_back(*part.mesh);
    }
    return trees;
  }

  std::unique_ptr<dismantle::World> world(const dismantle::Assembly& assembly,
                                          const dismantle::PreparedAssembly& prepared, const dismantle::Scene& scene,
                                          dismantle::MotionSpace space) const override {
    return std::make_unique<AcmeStepperWorld>(assembly, static_cast<const Trees&>(prepared), scene, space, params_);
  }

 private:
  AcmeStepperParameters params_;
};

}  // namespace

DISMANTLE_PLUGIN("acme.stepper", "0.1.0", "MIT", "https://example.org") {
  r.add<dismantle::Simulator, AcmeStepper, AcmeStepperParameters>(
      "acme.stepper", "Quasi-static steps, sampled contact.", {.source = "own", .provides = kProvides});
}
