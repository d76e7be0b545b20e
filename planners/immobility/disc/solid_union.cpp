#include "disc/solid_union.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dismantle::immobility {

namespace {
using Vec3 = Eigen::Vector3d;
}  // namespace

SolidUnion::SolidUnion(const std::vector<Solid>& solids, const Pose& frame) {
  for (const Solid& s : solids) solids_.push_back({&s, s.frame.inverse() * frame});
}

double SolidUnion::clearance(const Vec3& p) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Placed& s : solids_) {
    const Vec3 local = s.to_local * p;
    const double off = s.solid->box.squared_distance(local);
    if (off > 0 && (least <= 0 || off >= least * least)) continue;
    least = std::min(least, s.solid->bvh.signed_distance(local));
  }
  return least;
}

bool SolidUnion::contains(const Aabb& box) const {
  return std::any_of(solids_.begin(), solids_.end(), [&](const Placed& s) {
    if (!s.solid->bvh.inside(s.to_local * box.center())) return false;
    Aabb local;
    for (int k = 0; k < 8; ++k)
      local.extend(s.to_local *
                   Vec3((k & 1 ? box.hi : box.lo).x(), (k & 2 ? box.hi : box.lo).y(), (k & 4 ? box.hi : box.lo).z()));
    bool clear = true;
    s.solid->bvh.overlapping(local, [&](std::uint32_t) { clear = false; });
    return clear;
  });
}

}  // namespace dismantle::immobility
