/// The contact cache saves work and changes nothing: after a motion, a scene lists bitwise the same contacts as a new
/// one.
#include <gtest/gtest.h>

#include "dismantle/assembly.h"
#include "dismantle/run_context.h"
#include "dismantle/sdf/contact_scene.h"
#include "test_solids.h"

namespace dismantle::sdf {
namespace {

using Eigen::Vector3d;

std::vector<Placed> shapes_of(std::vector<Mesh> meshes) {
  Assembly assembly;
  for (Mesh& mesh : meshes) {
    Part part;
    part.id = static_cast<PartId>(assembly.parts.size());
    part.mesh = part.surface = std::make_shared<const Mesh>(std::move(mesh));
    assembly.parts.push_back(std::move(part));
  }
  RunContext context;
  return build_shapes(assembly, {}, context);
}

void expect_same(const std::vector<ContactPoint>& warm, const std::vector<ContactPoint>& fresh) {
  ASSERT_EQ(warm.size(), fresh.size());
  for (std::size_t i = 0; i < warm.size(); ++i) {
    const ContactPoint &a = warm[i], &b = fresh[i];
    ASSERT_EQ(a.gap, b.gap);
    ASSERT_EQ(a.normal, b.normal);
    ASSERT_EQ(a.point, b.point);
    ASSERT_EQ(a.owner, b.owner);
    ASSERT_EQ(a.surface, b.surface);
    ASSERT_EQ(a.plane_count, b.plane_count);
    for (int k = 0; k < a.plane_count; ++k) {
      ASSERT_EQ(a.planes[k].gap, b.planes[k].gap);
      ASSERT_EQ(a.planes[k].normal, b.planes[k].normal);
    }
  }
}

TEST(ContactCache, AWarmSceneListsWhatAFreshOneListsToTheLastBit) {
  constexpr double kMargin = 0.025;
  struct Case {
    const char* name;
    Mesh moving, fixed;
  };
  const std::vector<Case> cases = {
      {"rod with a thread beside a plate", test::threaded_rod(0.4, 0.03, 1.2, 12),
       test::box(Vector3d(-2, -2, -1), Vector3d(2, 2, -0.02))},
      {"ring about a rod with a thread", test::torus(0.75, 0.3), test::threaded_rod(0.4, 0.03, 1.2, 12)},
      {"box on a box", test::box(Vector3d(-1, -0.5, 0.01), Vector3d(1, 0.5, 0.6)),
       test::box(Vector3d(-2, -2, -0.5), Vector3d(2, 2, 0))},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const auto placed = shapes_of({c.moving, c.fixed});
    const auto nothing = [](PartId, PartId) { return 0.0; };
    ContactScene warm({{0, &placed[0], Pose{}}}, {{1, &placed[1], Pose{}}}, DistanceModel::exact, kMargin, nothing);
    const ContactScene blank = warm.with_margin(kMargin);
    Rng rng(21);
    std::vector<Pose> poses(1);
    std::vector<ContactPoint> remembered, measured;
    std::size_t listed = 0;
    for (int step = 0; step < 150; ++step) {
      // Back and forth near the start, by steps that are small, long, or zero in some direction.
      const double distance = step % 10 == 0 ? 0.2 : step % 3 == 0 ? 0.02 : 0.002;
      for (int k = 0; k < 3; ++k) poses[0].t[k] = 0.8 * poses[0].t[k] + distance * rng.uniform(-1, 1);
      const Vector3d turn = distance * Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
      poses[0].q = (rotation_from_vector(turn) * poses[0].q).normalized();
      warm.update(poses, remembered);
      ContactScene fresh = blank;
      fresh.update(poses, measured);
      ASSERT_NO_FATAL_FAILURE(expect_same(remembered, measured)) << "step " << step;
      listed += measured.size();
    }
    EXPECT_GT(listed, 100U);
    // The cache saved work.
    ContactScene again = blank;
    again.update(poses, measured);
    EXPECT_LT(warm.distance_queries(), 150 * again.distance_queries());
  }
}

}  // namespace
}  // namespace dismantle::sdf
