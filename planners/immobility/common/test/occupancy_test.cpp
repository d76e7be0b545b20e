// The occupancy grid of a solid agrees with the solid itself.
#include "dismantle/immobility/occupancy.h"

#include <gtest/gtest.h>

#include "dismantle/testing/held_shapes.h"

namespace dismantle {
namespace {

TEST(Occupancy, SaysOfEveryPointWhatTheSurfaceSays) {
  Rng rng(11);
  const shapes::Cased cased{{0.5, 0.4, 0.3}, 0.02, 0.1, 0.15};
  for (Mesh mesh : {shapes::tube(0.4, 0.8, -0.1, 0.1, 48), cased.around(), shapes::can(1, 0.6, 0.2, 0.3)}) {
    mesh = shapes::moved(mesh, shapes::random_pose(rng, 2));
    const TriangleBvh surface(mesh);
    const Aabb box = mesh.box();
    for (const double cell : {0.04, 0.15, 0.5}) {
      const immobility::Occupancy occupancy(surface, box, cell);
      int in = 0;
      std::vector<Eigen::Vector3d> points;  // of which only the last may be inside
      for (int i = 0; i < 4000; ++i) {
        Eigen::Vector3d p;
        for (int d = 0; d < 3; ++d) p[d] = rng.uniform(box.lo[d] - 0.1, box.hi[d] + 0.1);
        if (i % 2 == 0) {  // close to the surface
          const Eigen::Vector3d on = surface.closest(p).point;
          p = on + rng.uniform(-0.05, 0.05) * (p - on).normalized();
        }
        ASSERT_EQ(occupancy.inside(p), surface.inside(p)) << p.transpose() << ", cells of " << cell;
        in += surface.inside(p) ? 1 : 0;
        points.push_back(p);
        if (surface.inside(p) || points.size() == 100) {
          ASSERT_EQ(occupancy.any_inside(points), surface.inside(p)) << points.size() << " points";
          points.clear();
        }
      }
      EXPECT_GT(in, 200);
    }
  }
}

}  // namespace
}  // namespace dismantle
