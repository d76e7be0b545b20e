/// Cached contact data of two parts, kept between updates.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/sdf/surface_query.h"

namespace dismantle::sdf {

/// One sample point near or below a surface. The gap is linear in small motions of the bodies:
/// gap(x) = gap + sum over its bodies of sign * normal . (v + w x arm).
struct ContactPoint {
  double gap = 0;          ///< signed distance plus the pair's allowance; < 0 = in contact
  Eigen::Vector3d normal;  ///< world, unit, out of the touched surface
  Eigen::Vector3d point;   ///< world
  /// Within this distance the point meets only the surfaces listed here.
  double certain = 0;
  int owner = -1;    ///< moving body that carries the point, -1 = a fixed part
  int surface = -1;  ///< moving body that carries the surface, -1 = a fixed part
  PartId owner_part = 0, surface_part = 0;
  /// At convex edges and corners of the surface: the faces that meet there. The point is free if it is outside one of
  /// them, so gap(x) is the largest of all.
  int plane_count = 0;
  FacePlane planes[kMaxPlanes];  ///< normals in world axes, gaps as above
};

/// Region around a point in which the signed distance is that from the plane of one triangle.
struct LinearDistance {
  Eigen::Vector3d point, normal;  ///< frame of the surface
  double squared_radius = 0;
  std::uint32_t triangle = geometry::kNoIndex;
};

/// Last distance measurement of a point. It changes by at most the motion since then.
struct Anchor {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();  ///< frame of the surface
  /// Signed lower bound; NaN: unknown.
  float distance = std::numeric_limits<float>::quiet_NaN();
  bool is_known() const { return !std::isnan(distance); }
};

/// Contact points of one member against the solids of another.
struct DirectedContacts {
  bool ready = false;
  std::vector<double> wake;            ///< per block: odometer value from which it may be in contact
  std::vector<double> point_wake;      ///< per point: odometer value from which it may be in contact
  std::vector<Anchor> anchor;          ///< per point
  std::vector<std::uint32_t> hint;     ///< per point and solid: last closest triangle
  std::vector<std::uint32_t> linear;   ///< per point and solid: 1 + index in `known`; 0 = none
  std::vector<LinearDistance> known;   ///< distances valid while the point stays near
  std::vector<Eigen::Vector3d> extra;  ///< contact samples, owner's shape frame
  std::vector<std::uint32_t> extra_hint;
  std::vector<float> own, extra_own;  ///< per point: own allowance where it exceeds ContactPair::everywhere
};
struct ContactPair {
  std::uint32_t a = 0, b = 0;  ///< members; a is moving
  double allowed = 0;          ///< largest depth of any point
  double everywhere = 0;       ///< depth allowed to every point
  double wake = 0;             ///< odometer value from which the boxes may meet
  DirectedContacts ab, ba;     ///< points of a on b, points of b on a
};

/// Contacts of pairs in assembled position, where nearly every attempt begins. Measured once, shared by all scenes and
/// threads.
class RestContacts {
 public:
  struct Entry {
    ContactPair pair;  ///< a = 0 moves, b = 1 is fixed; odometer 0
    std::vector<ContactPoint> points;
  };
  /// `measure(entry)` is called once for each (moving, other), by the first thread that asks.
  template <class Measure>
  const Entry& of(PartId moving, PartId other, const Measure& measure) {
    Slot* slot = nullptr;
    {
      const std::lock_guard lock(mutex_);
      auto& place = slots_[{moving, other}];
      if (!place) place = std::make_unique<Slot>();
      slot = place.get();
    }
    std::call_once(slot->once, [&] { measure(slot->entry); });
    return slot->entry;
  }

 private:
  struct Slot {
    std::once_flag once;
    Entry entry;
  };
  std::mutex mutex_;
  std::map<std::pair<PartId, PartId>, std::unique_ptr<Slot>> slots_;
};

}  // namespace dismantle::sdf
