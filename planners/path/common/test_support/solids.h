/// Small solids for the tests of path planners.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/assembly.h"
#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::path::test {

using Eigen::Vector3d;
using shapes::boxes, shapes::moved;

inline Aabb block(double x0, double y0, double z0, double x1, double y1, double z1) {
  return {{x0, y0, z0}, {x1, y1, z1}};
}

/// A random rotation, and a translation within a cube about the origin of half width `spread`.
inline Pose random_pose(Rng& rng, double spread) {
  const Eigen::Quaterniond q(rng.normal(), rng.normal(), rng.normal(), rng.normal());
  return {spread * Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)), q.normalized()};
}

/// A square ring of bars 0.5 x 0.5 in the plane z = 0, 3 wide, with a gap in the middle of the side at +x.
inline Mesh open_ring(double gap) {
  return boxes({block(-1.5, -1.5, -0.25, -1, 1.5, 0.25), block(-1, -1.5, -0.25, 1.5, -1, 0.25),
                block(-1, 1, -0.25, 1.5, 1.5, 0.25), block(1, -1, -0.25, 1.5, -0.5 * gap, 0.25),
                block(1, 0.5 * gap, -0.25, 1.5, 1, 0.25)});
}

/// A ring without a gap, in the plane y = 0, around the side of the open ring that is opposite to the gap.
inline Mesh linked_ring() {
  return boxes({block(-3, -0.25, -1.5, -2.5, 0.25, 1.5), block(-2.5, -0.25, -1.5, 0, 0.25, -1),
                block(-2.5, -0.25, 1, 0, 0.25, 1.5), block(-0.5, -0.25, -1, 0, 0.25, 1)});
}

/// An assembly of these meshes, moved by `pose`.
inline Assembly assembly_of(const std::vector<Mesh>& meshes, const Pose& pose = {}) {
  Assembly a;
  for (const auto& mesh : meshes) {
    Part part;
    part.id = static_cast<PartId>(a.parts.size());
    part.name = "part" + std::to_string(part.id);
    part.mesh = part.surface = std::make_shared<const Mesh>(moved(mesh, pose));
    a.parts.push_back(std::move(part));
  }
  return a;
}

}  // namespace dismantle::path::test
