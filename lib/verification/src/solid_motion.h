/// How two solids of parts move past each other, both ways.
#pragma once

#include <vector>

#include "dismantle/geometry/relative_motion.h"
#include "dismantle/geometry/solid.h"
#include "geometry_names.h"

namespace dismantle {

struct SolidMotion {
  std::vector<Pose> poses_a, poses_b;
  Aabb box_b;
  verify::RelativeMotion forward;

  /// Poses of the parts `a` and `b`, to which the solids `x` and `y` belong. `displaced`: how far displaced corners may
  /// leave the boxes.
  SolidMotion(const std::vector<Pose>& a, const std::vector<Pose>& b, const verify::Solid& x, const verify::Solid& y,
              double displaced)
      : poses_a(in_frame(a, x.frame)),
        poses_b(in_frame(b, y.frame)),
        box_b(grown(y.box, displaced)),
        forward(poses_a, poses_b, grown(x.box, displaced)) {}
  verify::RelativeMotion backward() const { return {poses_b, poses_a, box_b}; }

 private:
  static std::vector<Pose> in_frame(const std::vector<Pose>& poses, const Pose& frame) {
    std::vector<Pose> result;
    result.reserve(poses.size());
    for (const auto& p : poses) result.push_back(p * frame);
    return result;
  }
  static Aabb grown(Aabb box, double by) {
    box.inflate(by);
    return box;
  }
};

}  // namespace dismantle
