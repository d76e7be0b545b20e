// Samples whose parts are pressed, clipped and cut into each other: the stated depth of a forced step, compared with
// points all over the surfaces at many instants.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/trials.h"
#include "last_resort.h"

namespace dismantle {
namespace {

using Eigen::Vector3d;

/// A part with points all over its surface, about equally spaced, vertices included.
struct Sampled {
  std::vector<geometry::Solid> solids;
  std::vector<Vector3d> points;
};

Sampled sampled(const Mesh& mesh) {
  constexpr double kPoints = 800;
  constexpr int kMost = 20;  // along an edge
  Sampled out{geometry::split_into_solids(mesh), mesh.vertices};
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += 0.5 * geometry::area_vector(mesh, t).norm();
  const double spacing = std::sqrt(area / kPoints);
  for (const Triangle& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
    const int n = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, kMost);
    for (int i = 0; i <= n; ++i)
      for (int k = 0; i + k <= n; ++k) out.points.push_back(a + (b - a) * i / n + (c - a) * k / n);
  }
  return out;
}

double deepest(const Sampled& of, const Pose& pose_of, const Sampled& in, const Pose& pose_in) {
  double most = 0;
  for (const geometry::Solid& solid : in.solids) {
    const Pose back = (pose_in * solid.frame).inverse() * pose_of;
    for (const Vector3d& p : of.points) {
      const Vector3d x = back * p;
      // The box bounds the depth from above.
      if (std::min((x - solid.box.lo).minCoeff(), (solid.box.hi - x).minCoeff()) <= most) continue;
      most = std::max(most, -solid.bvh.signed_distance(x));
    }
  }
  return most;
}

class ForcedSamples : public testing::TestWithParam<std::string> {};

TEST_P(ForcedSamples, TheStatedDepthAgreesWithBruteForceToATenth) {
  RunContext context;
  PrepareReport report;
  const Assembly assembly = prepare_assembly(samples::make(GetParam()), GetParam(), "", {}, context, report);
  const auto nothing = [](const Assembly&, PathOracle&, SequenceObserver&, RunContext&) {
    SequenceResult result;
    result.outcome = Outcome::exhausted;
    return result;
  };
  const Plan plan = fake::forced_run(assembly, std::make_shared<fake::Custom>(nothing)).plan;
  ASSERT_NE(plan.status, PlanStatus::partial);

  const double scale = assembly.normalization.scale;
  struct Here {
    Sampled surface;
    Pose pose;  // where it stands
  };
  std::map<std::string, Here> parts;
  for (const Part& part : assembly.parts) parts[part.name] = {sampled(*part.mesh), Pose{}};
  for (const PlanStep& step : plan.disassembly) {
    for (const PlanMove& move : step.moves) {
      std::vector<Pose> path;
      for (const Pose& p : move.poses) path.push_back(assembly.normalization.pose_to_internal(p));
      parts.at(move.part).pose = path.back();
      if (!step.forced || step.forced->part != move.part) continue;
      const Here &mine = parts.at(move.part), &other = parts.at(step.forced->other);  // the other does not move
      double brute = 0;
      constexpr std::size_t kInstants = 60;
      for (std::size_t k = 0; k <= kInstants; ++k) {
        const double at = static_cast<double>(k * (path.size() - 1)) / kInstants;
        const auto i = std::min(static_cast<std::size_t>(at), path.size() - 2);
        const Pose pose = screw_interpolate(path[i], path[i + 1], at - static_cast<double>(i));
        brute = std::max({brute, deepest(mine.surface, pose, other.surface, other.pose),
                          deepest(other.surface, other.pose, mine.surface, pose)});
      }
      EXPECT_NEAR(step.forced->depth * scale, brute, 0.1 * brute) << move.part << " past " << step.forced->other;
    }
  }
}

constexpr const char* kSlow = "o_ring";  // ten seconds of measuring curved surfaces

std::vector<std::string> not_rigid() {
  std::vector<std::string> names;
  for (const samples::Sample& s : samples::list())
    if (!s.clean && !s.solvable && (testing_support::nightly() || s.name != kSlow)) names.push_back(s.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(NotRigid, ForcedSamples, testing::ValuesIn(not_rigid()),
                         [](const auto& sample) { return sample.param; });

}  // namespace
}  // namespace dismantle
