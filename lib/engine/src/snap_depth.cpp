#include "snap_depth.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/verification/motion_depth.h"

namespace dismantle {
namespace {

constexpr std::size_t kPartAxes = 6;    // of the faces of a part, largest area first
constexpr double kSameAxis = 1 - 1e-6;  // cosine
constexpr std::uint64_t kPoses = 200;   // measured for one direction
constexpr double kMore = std::numeric_limits<double>::infinity();

std::vector<geometry::FaceAxis> axes_of(const Assembly& assembly, PartId a, PartId b) {
  std::vector<geometry::FaceAxis> axes;
  for (int k = 0; k < 3; ++k) axes.push_back({Eigen::Vector3d::Unit(k), 0});
  for (const PartId part : {a, b})
    for (const geometry::FaceAxis& face : geometry::largest_face_axes(*assembly.parts[part].mesh, kPartAxes))
      geometry::add_face(axes, face, kSameAxis);
  return axes;
}

}  // namespace

double straight_cut(const Assembly& assembly, const Verifier& verifier, PartId a, PartId b, double most,
                    const RunContext& context) {
  Aabb both = assembly.parts[a].mesh->box();
  both.extend(assembly.parts[b].mesh->box());
  const double far = 1.1 * both.size().norm();  // after so far they are apart
  std::vector<Path> ways;
  for (const geometry::FaceAxis& axis : axes_of(assembly, a, b))
    for (const double sign : {1.0, -1.0}) ways.push_back({{Pose{}}, {Pose{sign * far * axis.axis, Pose{}.q}}});
  for (const Path& out : ways) {
    if (context.should_stop()) return kMore;
    if (verifier.passes(a, b, Pose{}, {out[0][0], out[1][0]})) return -1;
  }
  MotionDepthMeter meter(assembly, verifier);
  MotionDepthOptions options;
  options.absolute = verifier.options().max_penetration;
  options.most_poses = kPoses;
  options.known_invalid = true;
  double least = kMore;
  for (const Path& out : ways) {
    options.stop_above = std::min(most, least);
    const std::optional<MotionDepth> cut = meter.deepest({a}, {{b, Pose{}}}, out, options, context);
    if (context.should_stop()) return kMore;
    if (const double excess = cut ? cut->excess() : 0; excess <= options.stop_above) least = std::min(least, excess);
    if (least <= options.absolute) break;
  }
  return least;
}

}  // namespace dismantle
