#include "snap_depth.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/verification/motion_depth.h"

namespace dismantle {
namespace {

constexpr std::size_t kPartAxes = 6;    // of the faces of a part, largest area first
constexpr double kSameAxis = 1 - 1e-6;  // cosine
constexpr std::uint64_t kPoses = 200;   // measured for one direction

std::vector<geometry::FaceAxis> axes_of(const Assembly& assembly, PartId a, PartId b) {
  std::vector<geometry::FaceAxis> axes;
  for (int k = 0; k < 3; ++k) axes.push_back({Eigen::Vector3d::Unit(k), 0});
  for (const PartId part : {a, b})
    for (const geometry::FaceAxis& face : geometry::largest_face_axes(*assembly.parts[part].mesh, kPartAxes))
      geometry::add_face(axes, face, kSameAxis);
  return axes;
}

}  // namespace

Hold straight_hold(const Assembly& assembly, const Verifier& verifier, PartId a, PartId b, double most,
                   const RunContext& context) {
  Aabb both = assembly.parts[a].mesh->box();
  both.extend(assembly.parts[b].mesh->box());
  const double far = 1.1 * both.size().norm();  // after so far they are apart
  MotionDepthMeter meter(assembly, verifier);
  MotionDepthOptions options;
  options.absolute = verifier.options().max_penetration;
  options.stop_above = most;
  options.most_poses = kPoses;
  options.known_invalid = true;
  bool little = false;
  for (const geometry::FaceAxis& axis : axes_of(assembly, a, b))
    for (const double sign : {1.0, -1.0}) {
      if (context.should_stop()) return Hold::deep;
      const Path out{{Pose{}}, {Pose{sign * far * axis.axis, Pose{}.q}}};
      if (verifier.passes(a, b, Pose{}, {out[0][0], out[1][0]})) return Hold::none;
      if (little) continue;
      const std::optional<MotionDepth> cut = meter.deepest({a}, {{b, Pose{}}}, out, options, context);
      little = !cut || cut->excess() <= most;
    }
  return little ? Hold::little : Hold::deep;
}

}  // namespace dismantle
