// Collision checks per second of the fcl simulator beside bare FCL, on the same meshes in the same poses. The ratio of
// "checked" to "bare_merged" is what the wrapping costs (containment, above all), to "bare" what merging flat faces
// gains on top; "penetration" adds depth where something collides.
#include <benchmark/benchmark.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"
#include "world.h"

namespace {

using namespace dismantle;
using namespace dismantle::mesh_collision;

struct Case {
  const char* sample;
  const char* moving;
  double reach;  ///< largest displacement of the centre, assembly units
  double turn;   ///< largest turn, rad
};
/// Near the assembled state, where planners spend their time; and all over the place.
constexpr Case kCases[] = {{"peg_in_hole", "peg", 0.05, 0.005},
                           {"peg_in_hole", "peg", 5, 1},
                           {"bolt_and_nut", "nut", 0.05, 0.005},
                           {"bolt_and_nut", "nut", 5, 1}};

struct Setup {
  explicit Setup(const Case& c) {
    RunContext context;
    PrepareReport report;
    assembly = prepare_assembly(samples::make(c.sample), c.sample, "", {}, context, report);
    for (const auto& part : assembly.parts) {
      bodies.placed.push_back({make_body(part, {parameters.certified_depth}), {}});
      (part.name == c.moving ? scene.moving : scene.fixed).push_back({part.id, {}});
      build(*part.mesh, models.emplace_back());
      build(bodies.placed.back().body->mesh, merged.emplace_back());
    }
    Rng rng(7);
    const Eigen::Vector3d center = bodies.placed[scene.moving[0].part].body->center;
    for (int i = 0; i < 512; ++i) {
      const auto draw = [&](double most) {
        return Eigen::Vector3d(rng.uniform(-most, most), rng.uniform(-most, most), rng.uniform(-most, most));
      };
      Pose pose;
      pose.q = rotation_from_vector(draw(c.turn));
      pose.t = center - pose.q * center + draw(c.reach);
      poses.push_back(pose);
      fcl::Transform3d transform = fcl::Transform3d::Identity();
      transform.linear() = pose.q.toRotationMatrix();
      transform.translation() = pose.t;
      transforms.push_back(transform);
    }
  }
  static void build(const Mesh& mesh, fcl::BVHModel<fcl::OBBRSSd>& model) {
    std::vector<fcl::Triangle> triangles;
    for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    model.beginModel();
    model.addSubModel(mesh.vertices, triangles);
    model.endModel();
    model.computeLocalAABB();
  }

  Parameters parameters;
  Assembly assembly;
  PreparedBodies bodies;
  Scene scene;
  std::vector<fcl::BVHModel<fcl::OBBRSSd>> models, merged;  ///< as given; flat faces merged
  std::vector<Pose> poses;
  std::vector<fcl::Transform3d, Eigen::aligned_allocator<fcl::Transform3d>> transforms;
};

Setup& setup(std::size_t i) {
  static std::map<std::size_t, std::unique_ptr<Setup>> all;
  auto& slot = all[i];
  if (!slot) slot = std::make_unique<Setup>(kCases[i]);
  return *slot;
}

void label(benchmark::State& state, double hits) {
  const auto& c = kCases[static_cast<std::size_t>(state.range(0))];
  state.SetItemsProcessed(state.iterations());
  state.SetLabel(std::string(c.sample) + (c.reach < 1 ? " near" : " far") + ", colliding " +
                 std::to_string(static_cast<int>(100 * hits / static_cast<double>(state.iterations()))) + " %");
}

void bare_on(benchmark::State& state, const Setup& s, const std::vector<fcl::BVHModel<fcl::OBBRSSd>>& models) {
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  std::size_t i = 0;
  double hits = 0;
  for (auto _ : state) {
    result.clear();
    hits += fcl::collide(&models[s.scene.moving[0].part], s.transforms[i], &models[s.scene.fixed[0].part],
                         fcl::Transform3d::Identity(), request, result) > 0;
    i = (i + 1) % s.transforms.size();
  }
  label(state, hits);
}

void bare(benchmark::State& state) {
  const Setup& s = setup(static_cast<std::size_t>(state.range(0)));
  bare_on(state, s, s.models);
}

void bare_merged(benchmark::State& state) {
  const Setup& s = setup(static_cast<std::size_t>(state.range(0)));
  bare_on(state, s, s.merged);
}

void checked(benchmark::State& state) {
  Setup& s = setup(static_cast<std::size_t>(state.range(0)));
  PairCheck check(s.parameters);
  const Body &a = *s.bodies.placed[s.scene.moving[0].part].body, &b = *s.bodies.placed[s.scene.fixed[0].part].body;
  std::size_t i = 0;
  double hits = 0;
  for (auto _ : state) {
    hits += check.collide(a, s.poses[i], b, Pose{});
    i = (i + 1) % s.poses.size();
  }
  label(state, hits);
}

void penetration(benchmark::State& state) {
  Setup& s = setup(static_cast<std::size_t>(state.range(0)));
  MeshWorld world(s.bodies, s.scene, MotionSpace::rigid, s.parameters);
  State at = world.initial_state();
  std::size_t i = 0;
  double hits = 0;
  for (auto _ : state) {
    at.bodies[0].pose = s.poses[i];
    hits += world.penetration(at) > 0;
    i = (i + 1) % s.poses.size();
  }
  label(state, hits);
}

BENCHMARK(bare)->DenseRange(0, std::size(kCases) - 1);
BENCHMARK(bare_merged)->DenseRange(0, std::size(kCases) - 1);
BENCHMARK(checked)->DenseRange(0, std::size(kCases) - 1);
BENCHMARK(penetration)->DenseRange(0, std::size(kCases) - 1);

}  // namespace

BENCHMARK_MAIN();
