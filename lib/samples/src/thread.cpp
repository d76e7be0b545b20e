#include <algorithm>
#include <cmath>
#include <numbers>

#include "solids.h"

namespace dismantle::samples {
namespace {

using std::numbers::pi;

/// Phases in [-pitch / 2, pitch / 2) at which the profile has a corner.
std::array<double, 4> corners(const ThreadProfile& p) {
  return {-p.pitch / 2 + p.root_flat / 2, -p.crest_flat / 2, p.crest_flat / 2, p.pitch / 2 - p.root_flat / 2};
}

/// Uniform angles, plus those at which a corner of the profile crosses an end plane, so that the end loops are
/// exact. Uniform angles close to an added one would give slivers and are left out.
std::vector<double> column_angles(const ThreadProfile& profile, double z0, double z1, int segments) {
  const double step = 2 * pi / segments;
  std::vector<double> exact;
  for (const double z : {z0, z1})
    for (const double phase : corners(profile)) {
      const double turns = (z - phase) / profile.pitch;
      const double angle = 2 * pi * (turns - std::floor(turns));
      const bool known = std::any_of(exact.begin(), exact.end(),
                                     [&](double e) { return std::abs(std::remainder(e - angle, 2 * pi)) < 1e-6; });
      if (!known) exact.push_back(angle);
    }
  std::vector<double> angles = exact;
  for (int i = 0; i < segments; ++i) {
    const double angle = step * i;
    const bool crowded = std::any_of(exact.begin(), exact.end(), [&](double e) {
      return std::abs(std::remainder(e - angle, 2 * pi)) < 0.25 * step;
    });
    if (!crowded) angles.push_back(angle);
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

struct ColumnPoint {
  double phase;  ///< z minus the climb of the helix at this column's angle
  std::uint32_t id;
};

}  // namespace

double ThreadProfile::radius(double phase) const {
  const double x = std::abs(phase - pitch * std::round(phase / pitch));
  const double flank = pitch / 2 - crest_flat / 2 - root_flat / 2;
  const double down = std::clamp((x - crest_flat / 2) / flank, 0.0, 1.0);
  return crest_radius + down * (root_radius - crest_radius);
}

ThreadWall thread_wall(const ThreadProfile& profile, double z0, double z1, int segments) {
  ThreadWall wall;
  const double pitch = profile.pitch;
  const auto angles = column_angles(profile, z0, z1, segments);
  std::vector<std::vector<ColumnPoint>> columns;
  for (const double angle : angles) {
    const double climb = pitch * angle / (2 * pi);
    std::vector<ColumnPoint> column;
    const auto put = [&](double phase, double z) {
      const double r = profile.radius(phase);
      column.push_back({phase, static_cast<std::uint32_t>(wall.mesh.vertices.size())});
      wall.mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    };
    put(z0 - climb, z0);
    const auto first = static_cast<long>(std::floor((z0 - climb) / pitch)) - 1;
    const auto last = static_cast<long>(std::ceil((z1 - climb) / pitch)) + 1;
    for (long turn = first; turn <= last; ++turn)
      for (const double corner : corners(profile)) {
        const double phase = corner + pitch * static_cast<double>(turn);
        const double z = phase + climb;
        // A corner that meets an end plane in this column coincides with the point on that plane.
        if (z > z0 + 1e-5 * pitch && z < z1 - 1e-5 * pitch) put(phase, z);
      }
    put(z1 - climb, z1);
    wall.bottom.push_back(column.front().id);
    wall.top.push_back(column.back().id);
    columns.push_back(std::move(column));
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const bool wraps = c + 1 == columns.size();
    const auto& left = columns[c];
    const auto& right = columns[wraps ? 0 : c + 1];
    const double shift = wraps ? -pitch : 0.0;  // the right column continues one turn further up
    const double gap = wraps ? angles.front() + 2 * pi - angles.back() : angles[c + 1] - angles[c];
    wall.half_gap = std::max(wall.half_gap, gap / 2);
    std::size_t l = 0, r = 0;
    while (l + 1 < left.size() || r + 1 < right.size()) {
      const bool step_right = l + 1 == left.size() ||
                              (r + 1 < right.size() && right[r + 1].phase + shift < left[l + 1].phase + 1e-6 * pitch);
      if (step_right) {
        wall.mesh.triangles.push_back({left[l].id, right[r].id, right[r + 1].id});
        ++r;
      } else {
        wall.mesh.triangles.push_back({left[l].id, right[r].id, left[l + 1].id});
        ++l;
      }
    }
  }
  return wall;
}

}  // namespace dismantle::samples
